// The thesis's sampling (Ni 2005, 3.3.2 and 4.2): the hits of rays on axis-aligned grids.
#pragma once

#include "preprocess/mesh/indexed_mesh.h"

#include <cstdint>
#include <span>
#include <vector>

namespace splice {

struct GridSample {
    Vec3f position;
    std::uint32_t triangle;
};

/// Mean edge length of the triangles / c, clamped to [h_min, h_max].
float thesis_spacing(const IndexedMesh& mesh, std::span<const std::uint32_t> triangles, double c, double h_min,
                     double h_max);

/// Hits of the grids of spacing h (lines through the multiples of h) on the triangles, each triangle on the grid across
/// its dominant normal axis only: the other two see the same surface again, and the spacing bound sqrt(3) h holds
/// without them. Then the patch's border, edge by edge at most h apart, with its corners (which the thesis misses,
/// figure 4.9).
std::vector<GridSample> sample_on_grids(const IndexedMesh& mesh, std::span<const std::uint32_t> triangles, float h);

}  // namespace splice
