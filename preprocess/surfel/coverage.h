// How often the surfel patches are covered, measured on random points that no part of the sampler has seen.
#pragma once

#include "preprocess/surfel/surfel_set.h"

#include <cstdint>
#include <optional>

namespace splice {

/// True when a surfel's disk covers a point of a surface whose normal (on the side of the shading normals) is given:
/// within its radius both along and off its plane, normals at most 60 degrees apart.
bool disk_covers(const SurfelSample& surfel, const Vec3f& point, const Vec3f& face_normal);

struct Coverage {
    double mean = 0;       // disks, of any patch, over a point
    double uncovered = 0;  // share of the points under no disk of their own patch
};

/// `points` area-uniform random points of the surfel patches, none without such patches; deterministic in `seed`.
std::optional<Coverage> measure_coverage(const IndexedMesh& mesh, const PatchSet& patches, const SurfelSet& surfels,
                                         std::size_t points, std::uint64_t seed);

}  // namespace splice
