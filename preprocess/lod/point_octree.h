// The point octree of a cloud (Pajarola et al. 2004, section 3.2): a node's points are divided among up to eight
// children by the octant they lie in about their mean, so the tree follows the points rather than space. Each node
// stands for all below it: an elliptical splat that covers their disks' projections, a sphere that holds the disks, a
// cone that holds their normals. Where the paper's bounds of a node come from the points, these do up to some thousand
// points; above, from its children's, which costs no more than a walk over the nodes.
#pragma once

#include "preprocess/lod/split_points.h"
#include "preprocess/model_format/point_node.h"

#include <span>
#include <vector>

namespace splice {

/// A leaf has no more surfels.
inline constexpr std::uint32_t kPointLeaf = 16;

/// Brings the surfels into the order of the tree (each node's are contiguous) and returns its nodes, as
/// format::SectionKind::kPointTree. The surfels' patches are not looked at. Nothing for no surfels. Deterministic for
/// any thread count. Fewer than 2^32 - 1 surfels.
std::vector<format::PointNode> build_point_octree(std::vector<format::Surfel>& surfels);

/// The same of surfels that are in the order of `split` already.
std::vector<format::PointNode> bound_point_octree(std::span<const format::Surfel> surfels, PointSplit split);

/// The same of a model whose surfels stay in their patches, and patches in their order: see split_patches. Octree
/// leaves have at most eight patches.
std::vector<format::PointNode> build_patch_point_octree(std::vector<format::Surfel>& surfels,
                                                        std::span<const format::Patch> patches,
                                                        std::span<const format::OctreeNode> octree);

}  // namespace splice
