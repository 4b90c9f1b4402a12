// Triangles without area whose three vertices differ ("caps": one vertex lies on the edge between the other two) cannot
// just be dropped from a surface: the triangle beyond that edge would keep a T-junction and the mesh a slit. Flipping
// the edge gives both halves area (Botsch and Kobbelt 2001, "A robust procedure to eliminate degenerate faces").
#pragma once

#include "preprocess/mesh/edge_table.h"

namespace splice {

struct CapFlip {
    std::uint32_t cap_corner;        // 3 * triangle + k: the vertex in the middle
    std::uint32_t beyond_half_edge;  // 3 * triangle + k: the long edge in the triangle beyond
};

/// True if the triangle has exactly zero area in double precision.
bool has_no_area(std::span<const Vec3f> positions, const Triangle& t);

/// Flips that do not touch each other, for caps whose long edge has one triangle with area beyond it; with corners
/// (x, y, d) there, x -> y the half-edge, and m the cap's middle, the two become (x, m, d) and (m, y, d).
/// No triangle may repeat a vertex.
std::vector<CapFlip> find_cap_flips(std::span<const Vec3f> positions, std::span<const Triangle> triangles);

}  // namespace splice
