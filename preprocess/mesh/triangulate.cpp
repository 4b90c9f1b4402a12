#include "preprocess/mesh/triangulate.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace splice {
namespace {

using Vec2d = Eigen::Vector2d;

/// Area-weighted normal of a polygon in space (Newell; Sutherland, Sproull and Schumacker 1974).
Vec3d newell_normal(std::span<const Vec3d> corners) {
    Vec3d normal = Vec3d::Zero();
    const Vec3d& origin = corners[0];
    for (std::size_t i = 0; i < corners.size(); ++i) {
        normal += (corners[i] - origin).cross(corners[(i + 1) % corners.size()] - origin);
    }
    return normal;
}

double cross(const Vec2d& a, const Vec2d& b, const Vec2d& c) {
    return (b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x());
}

class EarClipper {
  public:
    EarClipper(std::vector<Vec2d> points, std::vector<std::array<std::uint32_t, 3>>& triangles)
        : points_(std::move(points)),
          triangles_(triangles),
          next_(points_.size()),
          previous_(points_.size()),
          in_grid_(points_.size(), 0) {
        const auto n = static_cast<std::uint32_t>(points_.size());
        for (std::uint32_t i = 0; i < n; ++i) {
            next_[i] = (i + 1) % n;
            previous_[i] = (i + n - 1) % n;
        }
        build_grid();
    }

    void run() {
        std::size_t left = points_.size();
        std::uint32_t at = 0;
        std::size_t rejected = 0;
        // A hostile polygon must not cost the square of its size many times over: past the budget any corner will do.
        const std::uint64_t budget = 200 * points_.size() + 50'000'000;
        while (left > 3) {
            const bool give_up = rejected >= left || tests_ > budget;
            if (give_up || is_ear(at)) {
                clip(at);
                --left;
                rejected = 0;
                at = next_[next_[at]];  // skipping one keeps the triangles from fanning out of one corner
            } else {
                ++rejected;
                at = next_[at];
            }
        }
        triangles_.push_back({previous_[at], at, next_[at]});
    }

  private:
    double corner_turn(std::uint32_t i) const { return cross(points_[previous_[i]], points_[i], points_[next_[i]]); }

    /// Only reflex corners can lie inside an ear, and a corner that is convex stays so: a grid of the reflex ones.
    void build_grid() {
        std::vector<std::uint32_t> reflex;
        low_ = high_ = points_[0];
        for (std::uint32_t i = 0; i < points_.size(); ++i) {
            low_ = low_.cwiseMin(points_[i]);
            high_ = high_.cwiseMax(points_[i]);
            if (corner_turn(i) <= 0) {
                reflex.push_back(i);
                in_grid_[i] = 1;
            }
        }
        side_ = std::max<std::size_t>(1, static_cast<std::size_t>(std::sqrt(static_cast<double>(reflex.size()))));
        cell_begin_.assign(side_ * side_ + 1, 0);
        for (const std::uint32_t i : reflex)
            ++cell_begin_[cell(points_[i].x(), 0) + side_ * cell(points_[i].y(), 1) + 1];
        for (std::size_t c = 0; c < side_ * side_; ++c)
            cell_begin_[c + 1] += cell_begin_[c];
        cell_items_.resize(reflex.size());
        std::vector<std::size_t> cursor(cell_begin_.begin(), cell_begin_.end() - 1);
        for (const std::uint32_t i : reflex) {
            cell_items_[cursor[cell(points_[i].x(), 0) + side_ * cell(points_[i].y(), 1)]++] = i;
        }
    }

    std::size_t cell(double coordinate, int axis) const {
        const double extent = high_[axis] - low_[axis];
        if (!(extent > 0)) return 0;
        const double scaled = (coordinate - low_[axis]) / extent * static_cast<double>(side_);
        return std::min(side_ - 1, static_cast<std::size_t>(std::max(0.0, scaled)));
    }

    bool is_ear(std::uint32_t at) {
        ++tests_;
        const Vec2d &a = points_[previous_[at]], &b = points_[at], &c = points_[next_[at]];
        if (cross(a, b, c) <= 0) return false;
        const Vec2d low = a.cwiseMin(b).cwiseMin(c), high = a.cwiseMax(b).cwiseMax(c);
        for (std::size_t y = cell(low.y(), 1); y <= cell(high.y(), 1); ++y) {
            for (std::size_t x = cell(low.x(), 0); x <= cell(high.x(), 0); ++x) {
                for (std::size_t k = cell_begin_[x + side_ * y]; k < cell_begin_[x + side_ * y + 1]; ++k) {
                    ++tests_;
                    if (in_grid_[cell_items_[k]] != 0 && blocks(cell_items_[k], at)) return false;
                }
            }
        }
        return true;
    }

    /// True if reflex corner `r` lies in the ear at `at`. A bridge passes twice through the same points, so a corner at
    /// the place of one of the ear's blocks only if the polygon continues from it into the ear.
    bool blocks(std::uint32_t r, std::uint32_t at) const {
        const std::uint32_t ia = previous_[at], ic = next_[at];
        if (r == ia || r == at || r == ic) return false;
        const Vec2d &a = points_[ia], &b = points_[at], &c = points_[ic], &p = points_[r];
        const double ab = cross(a, b, p), bc = cross(b, c, p), ca = cross(c, a, p);
        if (ab < 0 || bc < 0 || ca < 0) return false;
        if (p == a || p == b || p == c) {
            return enters(p, points_[next_[r]], a, b, c) || enters(p, points_[previous_[r]], a, b, c);
        }
        return true;
    }

    /// True if the segment from the triangle's corner `p` towards `q` starts through its interior.
    static bool enters(const Vec2d& p, const Vec2d& q, const Vec2d& a, const Vec2d& b, const Vec2d& c) {
        if (p == a) return cross(a, b, q) > 0 && cross(c, a, q) > 0;
        if (p == b) return cross(b, c, q) > 0 && cross(a, b, q) > 0;
        return cross(c, a, q) > 0 && cross(b, c, q) > 0;
    }

    void clip(std::uint32_t at) {
        const std::uint32_t a = previous_[at], c = next_[at];
        triangles_.push_back({a, at, c});
        next_[a] = c;
        previous_[c] = a;
        in_grid_[at] = 0;
        for (const std::uint32_t i : {a, c}) {
            if (corner_turn(i) > 0) in_grid_[i] = 0;
        }
    }

    std::vector<Vec2d> points_;
    std::vector<std::array<std::uint32_t, 3>>& triangles_;
    std::vector<std::uint32_t> next_, previous_;
    std::vector<std::uint8_t> in_grid_;  // still in the polygon and reflex
    Vec2d low_, high_;
    std::size_t side_ = 1;
    std::vector<std::size_t> cell_begin_;
    std::vector<std::uint32_t> cell_items_;
    std::uint64_t tests_ = 0;
};

/// The diagonal that leaves two triangles facing the polygon's way; the shorter one if both do.
void split_quad(std::span<const Vec3d> q, const Vec3d& normal, std::vector<std::array<std::uint32_t, 3>>& triangles) {
    const auto facing = [&](int a, int b, int c) {
        return (q[static_cast<std::size_t>(b)] - q[static_cast<std::size_t>(a)])
            .cross(q[static_cast<std::size_t>(c)] - q[static_cast<std::size_t>(a)])
            .dot(normal);
    };
    const double worst02 = std::min(facing(0, 1, 2), facing(0, 2, 3));
    const double worst13 = std::min(facing(0, 1, 3), facing(1, 2, 3));
    const bool both = worst02 > 0 && worst13 > 0;
    const bool use02 = both ? (q[0] - q[2]).squaredNorm() <= (q[1] - q[3]).squaredNorm() : worst02 >= worst13;
    if (use02) {
        triangles.push_back({0, 1, 2});
        triangles.push_back({0, 2, 3});
    } else {
        triangles.push_back({0, 1, 3});
        triangles.push_back({1, 2, 3});
    }
}

}  // namespace

void triangulate_polygon(std::span<const Vec3d> corners, std::vector<std::array<std::uint32_t, 3>>& triangles) {
    if (corners.size() == 3) {
        triangles.push_back({0, 1, 2});
        return;
    }
    const Vec3d normal = newell_normal(corners);
    if (corners.size() == 4) {
        split_quad(corners, normal, triangles);
        return;
    }
    // Dropping the normal's largest axis is an affine map of the plane: orientation and containment survive.
    int drop = 0;
    normal.cwiseAbs().maxCoeff(&drop);
    const int u = (drop + 1) % 3, v = (drop + 2) % 3;
    std::vector<Vec2d> points;
    points.reserve(corners.size());
    for (const Vec3d& corner : corners) {
        points.emplace_back(normal[drop] < 0 ? corner[v] : corner[u], normal[drop] < 0 ? corner[u] : corner[v]);
    }
    EarClipper(std::move(points), triangles).run();
}

}  // namespace splice
