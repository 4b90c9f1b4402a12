// A model's point tree as the choice of a level of detail reads it: of each node what a visit needs, an array for each
// figure, so that the children of a node, which lie side by side, are looked at together.
#pragma once

#include "preprocess/model_format/point_node.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace splice {

/// Arrays go on for so many elements beyond the last node, that what is there may be read.
inline constexpr std::size_t kHierarchyLanes = 8;

/// Unit-box units; one element a node, breadth first, and kHierarchyLanes more.
struct PointHierarchy {
    std::vector<float> x, y, z;     // centre of ellipse and sphere
    std::vector<float> radius;      // of the sphere
    std::vector<float> extent;      // half of what it is long, whichever way; infinite for a single surfel
    std::vector<float> finest;      // the smallest extent in its subtree
    std::vector<float> nx, ny, nz;  // axis of the normal cone
    // What is left between the cone's rim and the horizon: how far the axis may be from the eye's side.
    std::vector<float> left_cosine, left_sine;             // the cosine 2: nothing
    std::vector<std::uint32_t> first_child, first_surfel;  // below as format::PointNode
    std::vector<std::uint8_t> below;                       // kChildren, kIsPatch
    std::vector<std::uint32_t> surfel_counts;
    std::vector<std::pair<std::uint32_t, std::uint32_t>> patches;  // of nodes that are patches: node, patch; ascending
    float largest_radius = 0;                                      // of the model's surfels

    static constexpr std::uint8_t kChildren = 15;  // how many; 0: a leaf
    static constexpr std::uint8_t kIsPatch = 16;   // stands for a patch, the whole and nothing else

    std::size_t size() const { return surfel_counts.size(); }
    bool empty() const { return size() == 0; }
    std::uint32_t child_count(std::uint32_t node) const { return below[node] & kChildren; }
};

PointHierarchy point_hierarchy(std::span<const format::PointNode> nodes, std::span<const format::Patch> patches,
                               float largest_radius);

/// Half of what is projected and compared with tau: what a node is long, whichever way; unit-box units.
float extent_of(const format::PointNode& node);

}  // namespace splice
