// Vertices of equal position made one.
#pragma once

#include "preprocess/mesh/indexed_mesh.h"

#include <cstdint>
#include <span>
#include <vector>

namespace splice {

struct Weld {
    std::vector<std::uint32_t> representative;  // of each position: the first one equal to it
    std::uint64_t merged = 0;                   // positions that are not their own representative
};

/// Exact equality, -0 and +0 being equal. Positions must be free of NaN. O(n), deterministic.
Weld weld_positions(std::span<const Vec3f> positions);

}  // namespace splice
