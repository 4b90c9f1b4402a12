// The shape of a point octree: which surfels are in which node.
#pragma once

#include "preprocess/mesh/indexed_mesh.h"
#include "preprocess/model_format/point_node.h"

#include <span>
#include <vector>

namespace splice {

struct PointSplit {
    std::vector<std::uint32_t> order;        // new place -> old
    std::vector<format::PointNode> nodes;    // breadth first; only ranges and children are filled in
    std::vector<std::uint32_t> level_begin;  // nodes of level l are [level_begin[l], level_begin[l + 1])
};

/// Deterministic for any thread count. At least one point, fewer than 2^32 - 1.
PointSplit split_points(std::span<const Vec3f> positions);

/// Of a model whose patches stay together: down to them, the nodes are those of the patch octree that have surfels and
/// divide them; each patch with surfels has a node, and below it a split of its own.
PointSplit split_patches(std::span<const format::Surfel> surfels, std::span<const format::Patch> patches,
                         std::span<const format::OctreeNode> octree);

inline Vec3f position_of(const format::Surfel& surfel) {
    return {surfel.position[0], surfel.position[1], surfel.position[2]};
}

inline std::vector<Vec3f> positions_of(std::span<const format::Surfel> surfels) {
    std::vector<Vec3f> positions;
    positions.reserve(surfels.size());
    for (const format::Surfel& surfel : surfels)
        positions.push_back(position_of(surfel));
    return positions;
}

}  // namespace splice
