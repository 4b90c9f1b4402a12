// Quadrics of shape and appearance together (Hoppe 1999, "New quadric metric for simplifying meshes with appearance
// attributes"): an attribute is linear over each triangle, and what it differs from that counts as a distance does. So
// normals that turn evenly cost nothing, and the best attributes of a place follow from the place.
#pragma once

#include "preprocess/mesh/indexed_mesh.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>

namespace splice {

class AttributeQuadric {
  public:
    /// Normal, colour, texture coordinates.
    static constexpr std::size_t kAttributes = 8;
    /// Times what a unit of each is worth as a distance.
    using Attributes = std::array<double, kAttributes>;

    /// A plane alone, which counts as no surface: it holds a border in place.
    void add_plane(const Vec3d& unit_normal, const Vec3d& point, double area) {
        add(plane_, area, unit_normal, -unit_normal.dot(point));
    }

    /// What a triangle is: its plane and its attributes as linear functions of the place. Across what is thinner than
    /// `width` they are taken to change less than their values there say: a sliver's attributes differ by noise over no
    /// distance, and such a slope would prevail a width away.
    void add_triangle(const std::array<Vec3d, 3>& corners, const std::array<Attributes, 3>& attributes,
                      std::size_t count, double width) {
        const Vec3d a = corners[1] - corners[0], b = corners[2] - corners[0];
        const Vec3d cross = a.cross(b);
        const double length = cross.norm();
        if (!(length > 0)) return;
        const double area = length / 2;
        add_plane(cross / length, corners[0], area);
        weight_ += area;
        // The slope g of least sum of (g.(p - c) - (value - mean))^2 over the corners p, with c their mean, plus
        // (width |g|)^2: in the plane's own axes, two equations.
        const Vec3d u = a.normalized(), v = cross.cross(a).normalized(), centre = corners[0] + (a + b) / 3;
        double uu = width * width, uv = 0, vv = width * width;
        std::array<double, 3> us{}, vs{};
        for (std::size_t k = 0; k < 3; ++k) {
            us[k] = u.dot(corners[k] - centre);
            vs[k] = v.dot(corners[k] - centre);
            uu += us[k] * us[k];
            uv += us[k] * vs[k];
            vv += vs[k] * vs[k];
        }
        const double determinant = uu * vv - uv * uv;
        if (!(determinant > 0)) return;
        for (std::size_t i = 0; i < count; ++i) {
            const double mean = (attributes[0][i] + attributes[1][i] + attributes[2][i]) / 3;
            double along_u = 0, along_v = 0;
            for (std::size_t k = 0; k < 3; ++k) {
                along_u += us[k] * (attributes[k][i] - mean);
                along_v += vs[k] * (attributes[k][i] - mean);
            }
            const Vec3d gradient =
                ((vv * along_u - uv * along_v) * u + (uu * along_v - uv * along_u) * v) / determinant;
            const double offset = mean - gradient.dot(centre);
            add(slope_, area, gradient, offset);
            gradient_[i] += area * gradient;
            offset_[i] += area * offset;
        }
    }

    AttributeQuadric& operator+=(const AttributeQuadric& other) {
        plane_ += other.plane_;
        slope_ += other.slope_;
        for (std::size_t i = 0; i < kAttributes; ++i) {
            gradient_[i] += other.gradient_[i];
            offset_[i] += other.offset_[i];
        }
        weight_ += other.weight_;
        return *this;
    }

    /// Area of the triangles.
    double weight() const { return weight_; }

    /// Squared distances to the planes, times areas.
    double distance(const Vec3d& v) const { return std::max(0.0, plane_.value(v)); }

    /// The same of the attributes that suit the place best.
    double difference(const Vec3d& v, std::size_t count) const {
        if (!(weight_ > 0)) return 0;
        double best = 0;
        for (std::size_t i = 0; i < count; ++i) {
            const double sum = gradient_[i].dot(v) + offset_[i];
            best += sum * sum;
        }
        return std::max(0.0, slope_.value(v) - best / weight_);
    }

    /// Those attributes; of no surface, zeros.
    Attributes best(const Vec3d& v, std::size_t count) const {
        Attributes attributes{};
        for (std::size_t i = 0; i < count && weight_ > 0; ++i)
            attributes[i] = (gradient_[i].dot(v) + offset_[i]) / weight_;
        return attributes;
    }

  private:
    // Sum of weight * (n.v + d)^2.
    struct Squares {
        double xx = 0, xy = 0, xz = 0, yy = 0, yz = 0, zz = 0;
        Vec3d linear = Vec3d::Zero();
        double constant = 0;

        Squares& operator+=(const Squares& o) {
            xx += o.xx;
            xy += o.xy;
            xz += o.xz;
            yy += o.yy;
            yz += o.yz;
            zz += o.zz;
            linear += o.linear;
            constant += o.constant;
            return *this;
        }
        double value(const Vec3d& v) const {
            const double squares = xx * v.x() * v.x() + yy * v.y() * v.y() + zz * v.z() * v.z();
            const double products = xy * v.x() * v.y() + xz * v.x() * v.z() + yz * v.y() * v.z();
            return squares + 2 * (products + linear.dot(v)) + constant;
        }
    };
    static void add(Squares& squares, double weight, const Vec3d& n, double d) {
        const Vec3d weighted = weight * n;
        squares.xx += weighted.x() * n.x();
        squares.xy += weighted.x() * n.y();
        squares.xz += weighted.x() * n.z();
        squares.yy += weighted.y() * n.y();
        squares.yz += weighted.y() * n.z();
        squares.zz += weighted.z() * n.z();
        squares.linear += d * weighted;
        squares.constant += weight * d * d;
    }

    Squares plane_, slope_;
    std::array<Vec3d, kAttributes> gradient_ = filled();
    std::array<double, kAttributes> offset_{};
    double weight_ = 0;

    static std::array<Vec3d, kAttributes> filled() {
        std::array<Vec3d, kAttributes> zeros;
        zeros.fill(Vec3d::Zero());
        return zeros;
    }
};

}  // namespace splice
