// Which nodes of a model's octree are drawn by triangles of all their patches together (format::OctreeNode::first_lod)
// in place of those patches' own triangles and surfels.
#pragma once

#include "engine/scene/patch_view.h"

#include <cstdint>
#include <utility>
#include <vector>

namespace splice {

class GpuModel;

/// What there is below a node of the octree, beside what the node says itself.
struct PatchGroupContent {
    std::uint64_t first_surfel = 0, surfels = 0;
    double triangles = 0;                       // finest ones of its triangle patches
    double triangle_area = 0, surfel_area = 0;  // unit-box units; of its patches of either kind
    bool has_levels = false;                    // itself or a node below it
};

/// One a node of the octree.
std::vector<PatchGroupContent> patch_group_contents(std::span<const format::OctreeNode> octree,
                                                    std::span<const format::Patch> patches,
                                                    std::span<const format::Lod> lods);

struct PatchGroup {
    std::uint32_t level;  // GpuModel::lods()
    std::uint32_t material, first_patch;
    std::uint32_t depth;   // of its node in the octree, counted from 1
    std::uint32_t number;  // of its level among the node's, finest first, counted from 0
};

struct PatchGroups {
    std::vector<PatchGroup> groups;
    std::vector<bool> chosen;                                      // nodes of the octree; empty: none
    std::vector<std::pair<std::uint32_t, std::uint32_t>> surfels;  // begin, end of the groups'; ascending, none empty
    DrawLoad load;
};

struct PatchGroupOptions {
    double tau = 1;  // pixels
    DrawCosts costs;
    bool two_sided = false;
    bool triangles_only = false;  // surfel patches are drawn by their triangles, too
};

/// The uppermost nodes in the picture that have a level within tau which costs less than what it takes the place of.
PatchGroups choose_patch_groups(const GpuModel& model, const PatchView& seen, const PatchGroupOptions& options);

}  // namespace splice
