// Halving along the widest of six axes, three of places and three of normals, at multiples of a run.
#include "preprocess/simplify/cluster_triangles.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

namespace splice {
namespace {

// A turn by about half a radian separates as much as the width of a run does.
constexpr float kNormalRange = 0.5f;

class Halver {
  public:
    explicit Halver(std::span<const ClusteredTriangle> triangles) : triangles_(triangles), order_(triangles.size()) {
        std::iota(order_.begin(), order_.end(), 0u);
        double area = 0;
        for (const ClusteredTriangle& triangle : triangles)
            area += static_cast<double>(triangle.area);
        width_ = static_cast<float>(std::sqrt(area * kClusterTriangles / static_cast<double>(triangles.size() + 1)));
    }

    std::vector<std::uint32_t> order() {
        halve(order_);
        return std::move(order_);
    }

  private:
    float along(std::uint32_t triangle, int axis) const {
        const ClusteredTriangle& of = triangles_[triangle];
        return axis < 3 ? of.centroid[axis] : of.normal[axis - 3];
    }

    void halve(std::span<std::uint32_t> part) {
        if (part.size() <= kClusterTriangles) {
            std::ranges::sort(part);
            return;
        }
        const int axis = widest(part);
        const std::size_t runs = (part.size() + kClusterTriangles - 1) / kClusterTriangles;
        const std::size_t half = runs / 2 * kClusterTriangles;
        std::ranges::nth_element(part, part.begin() + static_cast<std::ptrdiff_t>(half),
                                 [&](std::uint32_t a, std::uint32_t b) {
                                     const float at_a = along(a, axis), at_b = along(b, axis);
                                     return at_a != at_b ? at_a < at_b : a < b;
                                 });
        halve(part.first(half));
        halve(part.subspan(half));
    }

    int widest(std::span<const std::uint32_t> part) const {
        std::array<float, 6> low, high;
        for (int axis = 0; axis < 6; ++axis)
            low[static_cast<std::size_t>(axis)] = high[static_cast<std::size_t>(axis)] = along(part[0], axis);
        for (const std::uint32_t triangle : part)
            for (int axis = 0; axis < 6; ++axis) {
                const auto a = static_cast<std::size_t>(axis);
                low[a] = std::min(low[a], along(triangle, axis));
                high[a] = std::max(high[a], along(triangle, axis));
            }
        int best = 0;
        float most = -1;
        for (int axis = 0; axis < 6; ++axis) {
            const auto a = static_cast<std::size_t>(axis);
            const float range = (high[a] - low[a]) / (axis < 3 ? width_ : kNormalRange);
            if (range > most) {
                most = range;
                best = axis;
            }
        }
        return best;
    }

    std::span<const ClusteredTriangle> triangles_;
    std::vector<std::uint32_t> order_;
    float width_ = 0;  // of a run's surface
};

}  // namespace

ClusteredTriangle clustered_triangle(const Vec3f& a, const Vec3f& b, const Vec3f& c) {
    const Vec3f cross = (b - a).cross(c - a);
    const float length = cross.norm();
    return {(a + b + c) / 3, length > 0 ? Vec3f(cross / length) : Vec3f(Vec3f::Zero()), length / 2};
}

std::vector<std::uint32_t> cluster_order(std::span<const ClusteredTriangle> triangles) {
    return Halver(triangles).order();
}

}  // namespace splice
