// The order that a model's patches have in its file, and what of them that takes: boxes, normal cones, the octree.
#pragma once

#include "preprocess/build_model/normal_cone.h"
#include "preprocess/build_model/patch_octree.h"
#include "preprocess/cluster/patch_set.h"
#include "preprocess/simplify/simplify_patches.h"
#include "preprocess/surfel/surfel_set.h"

#include <vector>

namespace splice {

/// What of a patch is computed from its triangles and disks.
struct PatchExtent {
    Box bounds;
    NormalCone cone;
};

struct PatchLayout {
    std::vector<PatchExtent> extents;        // by patch
    std::vector<std::uint32_t> order;        // new place -> patch
    std::vector<format::OctreeNode> octree;  // over the new places; no levels of detail yet
};

PatchLayout lay_out_patches(const RenderVertices& vertices, const PatchLods& lods, const SurfelSet& surfels);

}  // namespace splice
