#include "preprocess/mesh/corner_normals.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

namespace splice {
namespace {

/// Sets of corners that share a normal, as a forest of parent links.
class CornerSets {
  public:
    explicit CornerSets(std::size_t corners) : parent_(corners) { std::iota(parent_.begin(), parent_.end(), 0u); }
    std::uint32_t find(std::uint32_t corner) {
        while (parent_[corner] != corner)
            corner = parent_[corner] = parent_[parent_[corner]];
        return corner;
    }
    void join(std::uint32_t a, std::uint32_t b) {
        a = find(a);
        b = find(b);
        parent_[std::max(a, b)] = std::min(a, b);
    }

  private:
    std::vector<std::uint32_t> parent_;
};

std::uint32_t next_corner(std::uint32_t corner) {
    return corner % 3 == 2 ? corner - 2 : corner + 1;
}

}  // namespace

std::vector<Vec3f> compute_corner_normals(std::span<const Vec3f> positions, std::span<const Triangle> triangles,
                                          const EdgeTable& edges, float crease_angle_degrees) {
    std::vector<Vec3f> face_normals(triangles.size());
    std::vector<Vec3f> weighted(3 * triangles.size());
    constexpr std::size_t kGrain = 4096;
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, triangles.size(), kGrain), [&](const auto& range) {
        for (std::size_t t = range.begin(); t < range.end(); ++t) {
            const std::array<Vec3d, 3> p = {positions[triangles[t][0]].cast<double>(),
                                            positions[triangles[t][1]].cast<double>(),
                                            positions[triangles[t][2]].cast<double>()};
            const Vec3d normal = (p[1] - p[0]).cross(p[2] - p[0]);
            const double twice_area = normal.norm();
            face_normals[t] = (normal / twice_area).cast<float>();
            for (std::size_t k = 0; k < 3; ++k) {
                const double angle = std::atan2(twice_area, (p[(k + 1) % 3] - p[k]).dot(p[(k + 2) % 3] - p[k]));
                weighted[3 * t + k] = face_normals[t] * static_cast<float>(angle);
            }
        }
    });

    const float smooth_cosine = std::cos(crease_angle_degrees * std::numbers::pi_v<float> / 180);
    CornerSets sets(3 * triangles.size());
    for (std::size_t e = 0; e < edges.size(); ++e) {
        const auto edge = edges.edge(e);
        if (edge.size() != 2 || same_direction(triangles, edge[0], edge[1])) continue;
        if (face_normals[edge[0] / 3].dot(face_normals[edge[1] / 3]) < smooth_cosine) continue;
        sets.join(edge[0], next_corner(edge[1]));
        sets.join(next_corner(edge[0]), edge[1]);
    }
    // Roots are the lowest corner of their set, so they come before the corners that copy from them.
    std::vector<Vec3f> normals(3 * triangles.size(), Vec3f::Zero());
    for (std::uint32_t c = 0; c < normals.size(); ++c)
        normals[sets.find(c)] += weighted[c];
    for (std::uint32_t c = 0; c < normals.size(); ++c) {
        const std::uint32_t root = sets.find(c);
        if (root != c) {
            normals[c] = normals[root];
            continue;
        }
        const float length = normals[c].norm();
        normals[c] = length > 1e-6f ? Vec3f(normals[c] / length) : Vec3f::Zero();
    }
    // Opposite faces that cancel out leave each corner with its own face's normal.
    for (std::uint32_t c = 0; c < normals.size(); ++c) {
        if (normals[c].isZero(0)) normals[c] = face_normals[c / 3];
    }
    return normals;
}

}  // namespace splice
