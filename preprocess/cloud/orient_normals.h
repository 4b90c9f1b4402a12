// Estimated normals have either sign; this gives neighbours the same side (Hoppe et al. 1992, section 3.3: a spanning
// tree of the neighbourhood graph that follows its most certain edges), in three steps: pieces of some thousand points
// at a time, in parallel, along edges that are certain; then the pieces, by the votes of all edges between each two;
// then whole components, outward where they are closed, else towards the positive end of the axis that they face.
#pragma once

#include "preprocess/cloud/cloud_surface.h"

#include <span>

namespace splice {

struct OrientationStats {
    std::uint64_t components = 0;  // that no edge joins
    std::uint64_t flipped_normals = 0;
};

/// Turns the disks' normals, and with them above and below. Deterministic for any thread count.
OrientationStats orient_normals(std::span<const Vec3f> positions, std::span<const StoredNeighbours> neighbours,
                                std::span<CloudDisk> disks);

}  // namespace splice
