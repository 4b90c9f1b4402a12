// An order of points in which every so many in a row are in a compact box: by halves along the longest side of what is
// left (Bentley 1975's k-d tree, its leaves full). Runs of a space-filling curve are in boxes twice as wide, and then a
// search for neighbours looks into twice as many.
#pragma once

#include <array>
#include <cstdint>
#include <span>

namespace splice {

struct alignas(16) PlacedPoint {
    std::array<float, 3> position;
    std::uint32_t index;
};

/// Brings the points into that order; the last block may not be full.
void order_by_blocks(std::span<PlacedPoint> points, std::size_t block);

}  // namespace splice
