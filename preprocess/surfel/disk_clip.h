// Where disks are cut: at creases and borders, beyond which there is no surface that they could stand for.
#pragma once

#include "preprocess/mesh/indexed_mesh.h"
#include "preprocess/surfel/voronoi_cover.h"

#include <array>
#include <cstdint>
#include <vector>

namespace splice {

/// The triangle across each triangle's edges, from corner k to k + 1; kNoTriangle at borders, non-manifold edges and
/// edges of more than 20 degrees, all of which end the surface that a disk stands for.
using SmoothNeighbours = std::vector<std::array<std::uint32_t, 3>>;
inline constexpr std::uint32_t kNoTriangle = 0xffffffffu;

SmoothNeighbours find_smooth_neighbours(const IndexedMesh& mesh);

/// For each site Surfel::clip. Every line leaves on its disk all cells that the disk owns, and all of the surface under
/// it that hangs together with its centre without an edge of more than 20 degrees: the disks of a smooth surface go on
/// overlapping. `owner`: of each cell, as close_cover returns it.
std::vector<std::uint16_t> fit_disk_clips(const IndexedMesh& mesh, const SmoothNeighbours& neighbours,
                                          const CoverCells& cells, const std::vector<CoverSite>& sites,
                                          const std::vector<std::uint32_t>& owner);

}  // namespace splice
