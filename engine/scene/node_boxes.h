// The boxes of what a frame draws, for the view that shows them: of the octree's nodes over patches, and of nodes of
// the point tree where surfels come from a cut through it.
#pragma once

#include "engine/scene/lod_cut.h"
#include "engine/scene/patch_view.h"
#include "engine/scene/point_hierarchy.h"
#include "preprocess/model_format/model_format.h"

#include <cstdint>
#include <span>
#include <vector>

namespace splice {

/// Unit-box units. Vertex shaders read it as it is.
struct NodeBox {
    float low[3];
    float high[3];
    std::uint32_t level;  // depth in its tree, counted from 1
};

/// What is drawn of a model.
struct DrawnNodes {
    std::span<const format::OctreeNode> octree;
    const PointHierarchy& hierarchy;
    const std::vector<bool>& groups;   // nodes of the octree that are drawn as a whole; empty: none
    const std::vector<bool>& patches;  // that are drawn one by one
    const LodCut& cut;
};

/// Of each node that is drawn as a whole; of each other node of the octree with patches, not its children's, that are
/// drawn one by one; of the cut's nodes, or where those are many, of the uppermost above them whose sphere is at most
/// `small_px` across, so that boxes do not cover what they are of. A node of the point tree has the box that the
/// spheres of its leaves are in.
std::vector<NodeBox> node_boxes(const DrawnNodes& drawn, const PatchView& seen, double small_px);

}  // namespace splice
