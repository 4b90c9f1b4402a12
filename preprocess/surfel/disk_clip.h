// Where disks are cut: at creases and borders, beyond which there is no surface that they could stand for.
#pragma once

#include "preprocess/mesh/indexed_mesh.h"
#include "preprocess/surfel/sheet.h"
#include "preprocess/surfel/voronoi_cover.h"

#include <cstdint>
#include <vector>

namespace splice {

/// For each site Surfel::clip. Every line leaves on its disk all cells that the disk owns, and all of the surface under
/// it that hangs together with its centre without an edge of more than 20 degrees: the disks of a smooth surface go on
/// overlapping. `owner`: of each cell, as close_cover returns it.
std::vector<std::uint16_t> fit_disk_clips(const IndexedMesh& mesh, const SmoothNeighbours& neighbours,
                                          const CoverCells& cells, const std::vector<CoverSite>& sites,
                                          const std::vector<std::uint32_t>& owner);

}  // namespace splice
