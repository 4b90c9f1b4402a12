// From points to disks that cover the surface they were sampled from: a plane through each point from its nearest
// neighbours (Hoppe et al. 1992; Pajarola et al. 2004, section 4.3), and in that plane a disk that covers the point's
// Voronoi cell. Disks that cover their cells leave no hole between points whose planes agree, and no disk is larger
// than it must be; the ellipse around all neighbours, which section 4.3 proposes, is twice as wide.
#pragma once

#include "preprocess/cloud/unit_cloud.h"
#include "preprocess/progress.h"

#include <array>
#include <cstdint>
#include <vector>

namespace splice {

struct CloudOptions {
    /// Nearest neighbours that define a point's plane, 6..64. More smooth out noise, and small features with it.
    /// 0: kUsualNeighbours, or kNoisyNeighbours in a cloud whose noise is as wide as its spacing.
    int neighbours = 0;
};

inline constexpr int kUsualNeighbours = 16, kNoisyNeighbours = 64;

struct CloudDisk {
    Vec3f normal;        // unit
    float radius;        // unit-box units, above 0
    float above, below;  // how far the surface leaves the plane, on the normal's side and on the other; at most radius
};

inline constexpr std::size_t kStoredNeighbours = 8;

/// The nearest first; fewer points: repeated.
using StoredNeighbours = std::array<std::uint32_t, kStoredNeighbours>;

struct CloudSurface {
    std::vector<CloudDisk> disks;  // one a point
    std::vector<StoredNeighbours> neighbours;
    int plane_neighbours = 0;  // that defined a point's plane
    std::uint64_t estimated_normals = 0;
    std::uint64_t border_points = 0;    // with no neighbour on one side
    std::uint64_t isolated_points = 0;  // much farther from their neighbours than those are from theirs, or than is
                                        // usual in the cloud; kept, with a disk of the usual size
};

/// Normals that the cloud has are kept; estimated ones have either sign (orient_normals.h). Deterministic for any
/// thread count.
CloudSurface estimate_surface(const UnitCloud& cloud, const CloudOptions& options, const Progress& progress = {});

}  // namespace splice
