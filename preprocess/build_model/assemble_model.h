// The stages' results -> a Model in file order: patches along the octree, everything else patch by patch in that order.
#pragma once

#include "preprocess/cluster/patch_set.h"
#include "preprocess/model_format/model.h"
#include "preprocess/simplify/simplify_patches.h"
#include "preprocess/surfel/surfel_set.h"

namespace splice {

Model assemble_model(const IndexedMesh& mesh, const PatchSet& patches, const RenderVertices& vertices,
                     const PatchLods& lods, const SurfelSet& surfels);

}  // namespace splice
