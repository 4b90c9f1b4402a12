// The patches' order in a model file, and the octree over it for hierarchical culling (issue of the LOD cut): patches
// are sorted along the Morton curve of their boxes' centres, so each octree node owns a contiguous range of them.
#pragma once

#include "preprocess/mesh/indexed_mesh.h"
#include "preprocess/model_format/model_format.h"

#include <limits>
#include <span>
#include <vector>

namespace splice {

struct Box {
    Vec3f min = Vec3f::Constant(std::numeric_limits<float>::infinity());
    Vec3f max = Vec3f::Constant(-std::numeric_limits<float>::infinity());

    void add(const Vec3f& point) {
        min = min.cwiseMin(point);
        max = max.cwiseMax(point);
    }
    void add(const Box& box) {
        min = min.cwiseMin(box.min);
        max = max.cwiseMax(box.max);
    }
};

inline constexpr std::uint32_t kMaxLeafPatches = 8;

struct PatchOctree {
    std::vector<std::uint32_t> order;  // new place -> old patch
    std::vector<format::OctreeNode>
        nodes;  // breadth first, as format::SectionKind::kOctree; leaves own at most kMaxLeafPatches
};
/// `bounds` has one box a patch, at least one.
PatchOctree build_patch_octree(std::span<const Box> bounds);

/// The same for patches that stay in the order they have, which should be one along which neighbours follow each other:
/// each node's are divided evenly.
std::vector<format::OctreeNode> build_octree_in_order(std::span<const Box> bounds);

}  // namespace splice
