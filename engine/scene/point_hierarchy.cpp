#include "engine/scene/point_hierarchy.h"

#include "engine/scene/splat_reach.h"
#include "preprocess/model_format/octahedral.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

namespace splice {

namespace {

constexpr std::size_t kConeSteps = 255;  // format::PointNode::cone_angle

struct Horizon {
    float cosine = 2, sine = 0;
};

// PointHierarchy::to_horizon and sine_to_horizon by cone_angle.
std::array<Horizon, kConeSteps + 1> horizons() {
    constexpr double kRounding = 1e-3;  // radians; normals are quantised
    const double horizon = std::acos(-kHorizon) - kRounding;
    std::array<Horizon, kConeSteps + 1> horizons;
    for (std::size_t step = 0; step <= kConeSteps; ++step) {
        const double left = horizon - static_cast<double>(step) * (std::numbers::pi / kConeSteps);
        if (left > 0) horizons[step] = {static_cast<float>(std::cos(left)), static_cast<float>(std::sin(left))};
    }
    return horizons;
}

// Breadth first, so that of nodes with the same surfels the uppermost is found.
void mark_patches(PointHierarchy& hierarchy, std::span<const format::Patch> patches) {
    std::vector<bool> found(patches.size(), false);
    for (std::size_t i = 0; i < hierarchy.size(); ++i) {
        const auto next = std::upper_bound(
            patches.begin(), patches.end(), hierarchy.first_surfel[i],
            [](std::uint64_t surfel, const format::Patch& p) { return surfel < p.first_surfel + p.surfel_count; });
        if (next == patches.end() || next->first_surfel != hierarchy.first_surfel[i] ||
            next->surfel_count != hierarchy.surfel_counts[i])
            continue;
        const auto patch = static_cast<std::size_t>(next - patches.begin());
        if (!found[patch]) {
            hierarchy.patches.emplace_back(static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(patch));
            hierarchy.kinds[i] |= kPatchNode;
        }
        found[patch] = true;
    }
}

}  // namespace

float extent_of(const format::PointNode& node) {
    return std::max(node.major, node.sphere_radius);
}

PointHierarchy point_hierarchy(std::span<const format::PointNode> nodes, std::span<const format::Patch> patches,
                               float largest_radius) {
    PointHierarchy hierarchy;
    hierarchy.largest_radius = largest_radius;
    for (std::vector<float>* floats : {&hierarchy.x, &hierarchy.y, &hierarchy.z, &hierarchy.radius, &hierarchy.extent,
                                       &hierarchy.finest, &hierarchy.normal_x, &hierarchy.normal_y, &hierarchy.normal_z,
                                       &hierarchy.to_horizon, &hierarchy.sine_to_horizon})
        floats->resize(nodes.size() + kMostSiblings - 1);
    for (std::vector<std::uint32_t>* numbers :
         {&hierarchy.first_child, &hierarchy.first_surfel, &hierarchy.surfel_counts})
        numbers->resize(nodes.size());
    hierarchy.child_counts.resize(nodes.size());
    hierarchy.kinds.resize(nodes.size() + kMostSiblings - 1);
    const std::array<Horizon, kConeSteps + 1> by_angle = horizons();
    for (std::size_t i = nodes.size(); i-- > 0;) {
        const format::PointNode& node = nodes[i];
        hierarchy.x[i] = node.position[0];
        hierarchy.y[i] = node.position[1];
        hierarchy.z[i] = node.position[2];
        hierarchy.radius[i] = node.sphere_radius;
        hierarchy.extent[i] = node.surfel_count > 1 ? extent_of(node) : std::numeric_limits<float>::infinity();
        hierarchy.finest[i] = hierarchy.extent[i];
        for (std::uint32_t child = 0; child < node.child_count; ++child)
            hierarchy.finest[i] = std::min(hierarchy.finest[i], hierarchy.finest[node.first_child + child]);
        const std::array<float, 3> normal = decode_octahedral(node.normal);
        hierarchy.normal_x[i] = normal[0];
        hierarchy.normal_y[i] = normal[1];
        hierarchy.normal_z[i] = normal[2];
        hierarchy.to_horizon[i] = by_angle[node.cone_angle].cosine;
        hierarchy.sine_to_horizon[i] = by_angle[node.cone_angle].sine;
        hierarchy.first_child[i] = node.first_child;
        hierarchy.first_surfel[i] = node.first_surfel;
        hierarchy.surfel_counts[i] = node.surfel_count;
        hierarchy.child_counts[i] = node.child_count;
        hierarchy.kinds[i] = static_cast<std::uint8_t>((node.child_count == 0 ? kLeafNode : 0) |
                                                       (node.surfel_count <= kSmallSurfels ? kSmallNode : 0));
    }
    mark_patches(hierarchy, patches);
    return hierarchy;
}

}  // namespace splice
