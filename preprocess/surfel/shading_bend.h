// How the shading normal leans from a surfel's plane and turns across its disk, to first order, so that lighting varies
// over a splat instead of being constant: Phong splatting's linear normal field (Botsch, Spernat and Kobbelt 2004),
// fitted to the surface.
#pragma once

#include "preprocess/surfel/voronoi_cover.h"

#include <array>
#include <cstdint>
#include <vector>

namespace splice {

/// b0, b1 of format::Surfel::shading_bend, then b2, b3, b4 per unit-box unit instead of per radius.
using ShadingBend = std::array<float, 5>;

/// Least squares over the cells under each site's disk; cells whose normal differs from the disk's by more than 60
/// degrees (across a crease) have no say. No bend where no cell has.
std::vector<ShadingBend> fit_shading_bends(const IndexedMesh& mesh, const CoverCells& cells,
                                           const std::vector<CoverSite>& sites);

/// As format::Surfel stores it.
std::array<std::int8_t, 5> encode_shading_bend(const ShadingBend& bend, float radius);

}  // namespace splice
