// A model's point tree as the choice of a level of detail reads it: an array for each figure of a node, so that
// siblings, which lie side by side, are read and judged eight at once (sibling_verdicts.h).
#pragma once

#include "preprocess/model_format/point_node.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace splice {

/// The most children of a node.
inline constexpr std::size_t kMostSiblings = 8;

enum NodeKind : std::uint8_t {
    kLeafNode = 1,
    kPatchNode = 2,  // stands for a patch, the whole and nothing else
    kSmallNode = 4,  // has no more than kSmallSurfels
};
inline constexpr std::uint32_t kSmallSurfels = 256;

/// Unit-box units; nodes breadth first. The arrays of floats and of kinds are longer than there are nodes by as many as
/// may be read beyond the last siblings.
struct PointHierarchy {
    std::vector<float> x, y, z;  // of a node's centre
    std::vector<float> radius;   // of the sphere that its disks are in
    std::vector<float> extent;   // half of what it is long, whichever way; infinite for a single surfel
    std::vector<float> finest;   // the smallest extent in its subtree
    std::vector<float> normal_x, normal_y, normal_z;  // axis of the normal cone
    std::vector<float> to_horizon;       // cosine of what is left between the cone's rim and the horizon; 2: nothing
    std::vector<float> sine_to_horizon;  // 0: nothing
    std::vector<std::uint32_t> first_child, first_surfel, surfel_counts;  // below as format::PointNode
    std::vector<std::uint8_t> child_counts;
    std::vector<std::uint8_t> kinds;                               // bits of NodeKind
    std::vector<std::pair<std::uint32_t, std::uint32_t>> patches;  // of nodes that are patches: node, patch; ascending
    float largest_radius = 0;                                      // of the model's surfels

    std::size_t size() const { return first_child.size(); }
    bool empty() const { return first_child.empty(); }
};

PointHierarchy point_hierarchy(std::span<const format::PointNode> nodes, std::span<const format::Patch> patches,
                               float largest_radius);

/// Half of what is projected and compared with tau: what a node is long, whichever way; unit-box units.
float extent_of(const format::PointNode& node);

}  // namespace splice
