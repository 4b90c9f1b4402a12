// From contracted clusters to the PatchSet that later stages read.
#pragma once

#include "preprocess/cluster/cluster_graph.h"
#include "preprocess/cluster/patch_set.h"

#include <cstdint>
#include <vector>

namespace splice {

/// One patch a live cluster, in slot order, which is along the space-filling curve. `slot_of_face` is, by slot of
/// `faces`, the slot of `graph` that the face began in. `surfel_slot` tells, for each live slot, whether the patch is
/// drawn as surfels. Takes the graph's merge tree. Leaves stats.seconds_* and stats.selection_auc alone.
PatchSet assemble_patches(const IndexedMesh& mesh, const FaceGraph& faces, ClusterGraph& graph,
                          const std::vector<std::uint32_t>& slot_of_face, const std::vector<std::uint8_t>& surfel_slot);

}  // namespace splice
