// Plane quadrics (Garland and Heckbert 1997; Ni 2005, equations 3.4 to 3.8), weighted by triangle area.
#pragma once

#include "preprocess/mesh/indexed_mesh.h"

#include <algorithm>

namespace splice {

/// Sum over planes of area * (n.v + d)^2, and the sum of the areas: value(v) / weight is a mean squared distance.
class PlaneQuadric {
  public:
    void add_plane(const Vec3d& unit_normal, const Vec3d& point, double area) {
        const double d = -unit_normal.dot(point);
        const Vec3d weighted = area * unit_normal;
        xx_ += weighted.x() * unit_normal.x();
        xy_ += weighted.x() * unit_normal.y();
        xz_ += weighted.x() * unit_normal.z();
        yy_ += weighted.y() * unit_normal.y();
        yz_ += weighted.y() * unit_normal.z();
        zz_ += weighted.z() * unit_normal.z();
        linear_ += d * weighted;
        constant_ += area * d * d;
        weight_ += area;
    }

    PlaneQuadric& operator+=(const PlaneQuadric& other) {
        xx_ += other.xx_;
        xy_ += other.xy_;
        xz_ += other.xz_;
        yy_ += other.yy_;
        yz_ += other.yz_;
        zz_ += other.zz_;
        linear_ += other.linear_;
        constant_ += other.constant_;
        weight_ += other.weight_;
        return *this;
    }

    /// Never negative: rounding below zero counts as zero.
    double value(const Vec3d& v) const {
        const double squares = xx_ * v.x() * v.x() + yy_ * v.y() * v.y() + zz_ * v.z() * v.z();
        const double products = xy_ * v.x() * v.y() + xz_ * v.x() * v.z() + yz_ * v.y() * v.z();
        return std::max(0.0, squares + 2 * (products + linear_.dot(v)) + constant_);
    }

    double weight() const { return weight_; }

  private:
    double xx_ = 0, xy_ = 0, xz_ = 0, yy_ = 0, yz_ = 0, zz_ = 0;
    Vec3d linear_ = Vec3d::Zero();
    double constant_ = 0;
    double weight_ = 0;
};

}  // namespace splice
