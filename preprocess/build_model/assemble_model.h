// The stages' results -> a Model in file order: patches along the octree, everything else patch by patch in that order.
#pragma once

#include "preprocess/build_model/patch_layout.h"
#include "preprocess/cluster/patch_set.h"
#include "preprocess/model_format/model.h"
#include "preprocess/simplify/simplify_patches.h"
#include "preprocess/simplify/simplify_regions.h"
#include "preprocess/surfel/surfel_set.h"

namespace splice {

Model assemble_model(const IndexedMesh& mesh, const PatchSet& patches, const RenderVertices& vertices,
                     const PatchLods& lods, const SurfelSet& surfels, const PatchLayout& layout,
                     const RegionLods& regions);

}  // namespace splice
