// A point's nearest neighbours as seen from it, and what is computed of them for every point of a cloud: their moments,
// and the cell among the nearest sixteen. With 256-bit vectors where the processor has them (AVX2); the same bits
// without, as both do the same operations in the same order.
#pragma once

#include "preprocess/cloud/neighbour_search.h"
#include "preprocess/model_format/tangent_frame.h"

#include <array>
#include <cstdint>

namespace splice {

struct Vicinity {
    static constexpr std::size_t kStep = 16;  // neighbours that are looked at together

    std::size_t count = 0;
    // Offsets from the point, the nearest neighbour first; 0 from `count` to the next multiple of kStep.
    alignas(64) std::array<float, NeighbourSearch::kMostNeighbours> x, y, z;
    std::array<std::uint32_t, NeighbourSearch::kMostNeighbours> index;

    Vec3f offset(std::size_t i) const { return {x[i], y[i], z[i]}; }
    float distance(std::size_t i) const { return offset(i).norm(); }
};

/// Sums over offsets and over their products.
struct Moments {
    float x, y, z, xx, xy, xz, yy, yz, zz;
};

/// The plane's coordinates are along s and t, heights along the normal. Neighbours that rise more steeply from it than
/// `least_cosine` says belong to another sheet, or are noise.
struct CellPlane {
    Vec3f normal;
    TangentFrame frame;
    float least_cosine;
};

/// The Voronoi cell of the point in a plane, among its neighbours' projections, as far as `limit` (voronoi_cell.h does
/// the same for any number of neighbours).
struct SmallCell {
    float reach = 0;             // distance of the farthest corner between two neighbours; 0 if there is none
    float above = 0, below = 0;  // heights of neighbours that the cell borders on
    bool is_bounded = false;     // by neighbours all around, nearer than the limit
};

struct VicinityFunctions {
    /// Of the first `count` neighbours.
    Moments (*moments)(const Vicinity& vicinity, std::size_t count);
    /// Among the first kStep neighbours.
    SmallCell (*small_cell)(const Vicinity& vicinity, const CellPlane& plane, float limit);
};

/// The fastest of this processor, or those for every one.
VicinityFunctions vicinity_functions(bool wide = true);

}  // namespace splice
