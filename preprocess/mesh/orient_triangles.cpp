#include "preprocess/mesh/orient_triangles.h"

#include <Eigen/Geometry>
#include <algorithm>

namespace splice {
namespace {

constexpr std::uint32_t kNone = 0xffffffffu;

/// Six times the signed volume between a triangle and the origin.
double signed_volume(std::span<const Vec3f> positions, const Triangle& t) {
    const Vec3d a = positions[t[0]].cast<double>(), b = positions[t[1]].cast<double>(),
                c = positions[t[2]].cast<double>();
    return a.dot(b.cross(c));
}

}  // namespace

std::vector<std::uint8_t> find_flipped_triangles(std::span<const Vec3f> positions, std::span<const Triangle> triangles,
                                                 const EdgeTable& edges) {
    std::vector<std::uint8_t> flipped(triangles.size(), 0);
    std::vector<std::uint32_t> opposite(3 * triangles.size(), kNone);
    bool consistent = true;
    for (std::size_t e = 0; e < edges.size(); ++e) {
        const auto edge = edges.edge(e);
        if (edge.size() != 2) continue;
        opposite[edge[0]] = edge[1];
        opposite[edge[1]] = edge[0];
        consistent &= !same_direction(triangles, edge[0], edge[1]);
    }
    if (consistent) return flipped;

    std::vector<std::uint8_t> visited(triangles.size(), 0);
    std::vector<std::uint32_t> component;
    for (std::uint32_t seed = 0; seed < triangles.size(); ++seed) {
        if (visited[seed] != 0) continue;
        component.assign(1, seed);
        visited[seed] = 1;
        bool orientable = true, closed = true;
        std::size_t turned = 0;
        for (std::size_t i = 0; i < component.size(); ++i) {
            const std::uint32_t t = component[i];
            turned += flipped[t];
            for (std::uint32_t h = 3 * t; h < 3 * t + 3; ++h) {
                if (opposite[h] == kNone) {
                    closed = false;
                    continue;
                }
                const std::uint32_t neighbour = opposite[h] / 3;
                const auto wanted =
                    static_cast<std::uint8_t>(flipped[t] ^ (same_direction(triangles, h, opposite[h]) ? 1 : 0));
                if (visited[neighbour] == 0) {
                    visited[neighbour] = 1;
                    flipped[neighbour] = wanted;
                    component.push_back(neighbour);
                } else if (flipped[neighbour] != wanted) {
                    orientable = false;
                }
            }
        }
        bool invert = 2 * turned > component.size();
        if (orientable && turned > 0 && closed) {
            double volume = 0;
            for (const std::uint32_t t : component) {
                volume += signed_volume(positions, triangles[t]) * (flipped[t] != 0 ? -1 : 1);
            }
            if (volume != 0) invert = volume < 0;
        }
        for (const std::uint32_t t : component) {
            if (!orientable || turned == 0) {
                flipped[t] = 0;
            } else if (invert) {
                flipped[t] ^= 1;
            }
        }
    }
    return flipped;
}

bool is_inside_out(std::span<const Vec3f> positions, std::span<const Triangle> triangles, const EdgeTable& edges) {
    for (std::size_t e = 0; e < edges.size(); ++e) {
        const auto edge = edges.edge(e);
        if (edge.size() != 2 || same_direction(triangles, edge[0], edge[1])) return false;
    }
    double volume = 0;
    for (const Triangle& t : triangles)
        volume += signed_volume(positions, t);
    return volume < 0;
}

}  // namespace splice
