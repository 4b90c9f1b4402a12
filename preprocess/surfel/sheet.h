// The surface under a disk: what hangs together with its centre over smooth edges, and how far that reaches.
#pragma once

#include "preprocess/mesh/indexed_mesh.h"
#include "preprocess/model_format/surfel_clip.h"

#include <array>
#include <cstdint>
#include <optional>
#include <unordered_set>
#include <vector>

namespace splice {

/// The triangle across each triangle's edges, from corner k to k + 1; kNoTriangle at borders, non-manifold edges and
/// edges of more than 20 degrees, all of which end the surface that a disk stands for.
using SmoothNeighbours = std::vector<std::array<std::uint32_t, 3>>;
inline constexpr std::uint32_t kNoTriangle = 0xffffffffu;

SmoothNeighbours find_smooth_neighbours(const IndexedMesh& mesh);

/// How far something reaches from a disk's centre in each of the directions of clip lines, radii; at least 0.
using Support = std::array<float, kClipDirections>;

/// Unit vectors along the tangents, anticlockwise from the first.
const std::array<Vec2f, kClipDirections>& clip_directions();

void reach_to(Support& support, const Vec2f& point);

/// A disk's own coordinates, as the shaders see them, in radii.
struct DiskFrame {
    Vec3f centre, s, t, n;
    float radius;

    DiskFrame(const Vec3f& centre_, const Vec3f& normal, float radius_);
    Vec2f operator()(const Vec3f& point) const {
        const Vec3f d = point - centre;
        return Vec2f(d.dot(s), d.dot(t)) / radius;
    }
};

class Sheet {
  public:
    Sheet(const IndexedMesh& mesh, const SmoothNeighbours& neighbours) : mesh_(mesh), neighbours_(neighbours) {}

    /// Whether the surface ends under the disk, whose centre lies on triangle `at`, and then how far it reaches.
    std::optional<Support> end_of(std::uint32_t at, const DiskFrame& frame);

  private:
    const IndexedMesh& mesh_;
    const SmoothNeighbours& neighbours_;
    std::vector<std::uint32_t> triangles_;
    std::unordered_set<std::uint32_t> seen_;
    std::vector<std::array<Vec2f, 3>> corners_;
};

/// For each triangle with an edge at which the surface ends: how wide it is around the middle of the triangle, where it
/// is narrowest, at most 2 `reach`, within which it is looked at. 2 `reach` for all others. Unit-box units.
std::vector<float> sheet_widths(const IndexedMesh& mesh, const SmoothNeighbours& neighbours, float reach);

}  // namespace splice
