#include "preprocess/mesh/flip_caps.h"

#include <Eigen/Geometry>

namespace splice {
namespace {

double squared_length(std::span<const Vec3f> positions, const Triangle& t, std::size_t k) {
    return (positions[t[(k + 1) % 3]].cast<double>() - positions[t[k]].cast<double>()).squaredNorm();
}

}  // namespace

bool has_no_area(std::span<const Vec3f> positions, const Triangle& t) {
    const Vec3d a = positions[t[0]].cast<double>();
    const Vec3d u = positions[t[1]].cast<double>() - a, v = positions[t[2]].cast<double>() - a;
    return u.cross(v).squaredNorm() == 0;
}

std::vector<CapFlip> find_cap_flips(std::span<const Vec3f> positions, std::span<const Triangle> triangles) {
    std::vector<std::uint8_t> is_cap(triangles.size(), 0);
    bool any = false;
    for (std::size_t t = 0; t < triangles.size(); ++t) {
        is_cap[t] = has_no_area(positions, triangles[t]) ? 1 : 0;
        any |= is_cap[t] != 0;
    }
    std::vector<CapFlip> flips;
    if (!any) return flips;
    const EdgeTable edges = build_edge_table(triangles, positions.size());
    std::vector<std::uint8_t> touched(triangles.size(), 0);
    for (std::size_t e = 0; e < edges.size(); ++e) {
        const auto edge = edges.edge(e);
        if (edge.size() != 2 || is_cap[edge[0] / 3] == is_cap[edge[1] / 3]) continue;
        const std::uint32_t of_cap = is_cap[edge[0] / 3] != 0 ? edge[0] : edge[1];
        const std::uint32_t beyond = is_cap[edge[0] / 3] != 0 ? edge[1] : edge[0];
        const std::uint32_t cap = of_cap / 3, k = of_cap % 3;
        const double length = squared_length(positions, triangles[cap], k);
        const bool longest = length > squared_length(positions, triangles[cap], (k + 1) % 3) &&
                             length > squared_length(positions, triangles[cap], (k + 2) % 3);
        if (!longest || touched[cap] != 0 || touched[beyond / 3] != 0) continue;
        touched[cap] = touched[beyond / 3] = 1;
        flips.push_back({3 * cap + (k + 2) % 3, beyond});
    }
    return flips;
}

}  // namespace splice
