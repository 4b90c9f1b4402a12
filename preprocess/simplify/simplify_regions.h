// Triangle levels of detail across patches. Inside patches alone, locked borders leave most of a small patch's
// triangles where they are; here the patches of a node of the octree are simplified together, with only the node's own
// border locked, and upwards so on: each node goes on from what is left of its children, whose borders become its
// inside; the root from levels that are fine enough for the whole to be looked at. Neighbours share the border's finest
// edges whatever level or patch is drawn of each, so nothing cracks.
#pragma once

#include "preprocess/model_format/model_format.h"
#include "preprocess/simplify/simplify_patches.h"

#include <span>
#include <vector>

namespace splice {

struct RegionLods {
    std::vector<format::Vertex> vertices;  // with the normal and colour that suit what they stand for; see `indices`
    std::vector<std::uint32_t> indices;    // into RenderVertices::vertices, then `vertices`
    // Grouped by node, finer before coarser. `error`: the larger of RegionLevel's two, what children lost included.
    std::vector<PatchLods::Level> levels;
    std::vector<std::uint32_t> level_begin;  // size nodes + 1, into levels
};

/// `order`: the octree's places -> patches. Nodes of patches of several materials, and those with few triangles except
/// the root, have no levels. Deterministic for any thread count.
RegionLods simplify_regions(const IndexedMesh& mesh, const RenderVertices& vertices, const PatchSet& patches,
                            std::span<const std::uint32_t> order, std::span<const format::OctreeNode> octree,
                            const Progress& progress = {});

}  // namespace splice
