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

struct Limit {
    float cosine = 2, sine = 0;  // never
};

// Indexed by cone_angle.
std::array<Limit, kConeSteps + 1> cone_limits() {
    constexpr double kRounding = 1e-3;  // radians; normals are quantised
    const double horizon = std::acos(-kHorizon) - kRounding;
    std::array<Limit, kConeSteps + 1> limits;
    for (std::size_t step = 0; step <= kConeSteps; ++step) {
        const double left = horizon - static_cast<double>(step) * (std::numbers::pi / kConeSteps);
        if (left > 0) limits[step] = {static_cast<float>(std::cos(left)), static_cast<float>(std::sin(left))};
    }
    return limits;
}

// Of nodes with the same surfels, the uppermost; nodes are breadth first.
void mark_patches(PointHierarchy& hierarchy, std::span<const format::PointNode> nodes,
                  std::span<const format::Patch> patches) {
    std::vector<bool> found(patches.size(), false);
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        const auto next = std::upper_bound(
            patches.begin(), patches.end(), nodes[i].first_surfel,
            [](std::uint64_t surfel, const format::Patch& p) { return surfel < p.first_surfel + p.surfel_count; });
        if (next == patches.end() || next->first_surfel != nodes[i].first_surfel ||
            next->surfel_count != nodes[i].surfel_count)
            continue;
        const auto patch = static_cast<std::size_t>(next - patches.begin());
        if (!found[patch]) {
            hierarchy.patches.emplace_back(static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(patch));
            hierarchy.below[i] |= PointHierarchy::kIsPatch;
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
    if (nodes.empty()) return hierarchy;
    hierarchy.largest_radius = largest_radius;
    const std::size_t size = nodes.size() + kHierarchyLanes;
    for (auto* array :
         {&hierarchy.x, &hierarchy.y, &hierarchy.z, &hierarchy.radius, &hierarchy.extent, &hierarchy.finest,
          &hierarchy.nx, &hierarchy.ny, &hierarchy.nz, &hierarchy.left_cosine, &hierarchy.left_sine})
        array->resize(size);
    hierarchy.first_child.resize(size);
    hierarchy.first_surfel.resize(size);
    hierarchy.below.resize(size);
    hierarchy.surfel_counts.resize(nodes.size());
    const std::array<Limit, kConeSteps + 1> limits = cone_limits();
    for (std::size_t i = nodes.size(); i-- > 0;) {
        const format::PointNode& node = nodes[i];
        const float extent = node.surfel_count > 1 ? extent_of(node) : std::numeric_limits<float>::infinity();
        float finest = extent;
        for (std::uint32_t child = 0; child < node.child_count; ++child)
            finest = std::min(finest, hierarchy.finest[node.first_child + child]);
        const std::array<float, 3> normal = decode_octahedral(node.normal);
        hierarchy.x[i] = node.position[0];
        hierarchy.y[i] = node.position[1];
        hierarchy.z[i] = node.position[2];
        hierarchy.radius[i] = node.sphere_radius;
        hierarchy.extent[i] = extent;
        hierarchy.finest[i] = finest;
        hierarchy.nx[i] = normal[0];
        hierarchy.ny[i] = normal[1];
        hierarchy.nz[i] = normal[2];
        hierarchy.left_cosine[i] = limits[node.cone_angle].cosine;
        hierarchy.left_sine[i] = limits[node.cone_angle].sine;
        hierarchy.first_child[i] = node.first_child;
        hierarchy.first_surfel[i] = node.first_surfel;
        hierarchy.below[i] = node.child_count;
        hierarchy.surfel_counts[i] = node.surfel_count;
    }
    mark_patches(hierarchy, nodes, patches);
    return hierarchy;
}

}  // namespace splice
