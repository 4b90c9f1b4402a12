// Pajarola et al. 2004, section 6.2. All in the model's unit-box space, where nodes need not be transformed.
#include "engine/scene/lod_cut.h"

#include "engine/scene/splat_reach.h"
#include "preprocess/model_format/octahedral.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

namespace splice {

namespace {

constexpr double kConeSteps = 255;  // format::PointNode::cone_angle
// Subtrees that are walked at once.
constexpr std::size_t kTasks = 64;
constexpr int kMostRounds = 8;
// Surfels that are not worth looking for nodes that face away.
constexpr std::uint32_t kHardlyAway = 256;

glm::dvec3 position_of(const format::PointNode& node) {
    return {node.position[0], node.position[1], node.position[2]};
}

// Not below the cosine of `angle` in [0, pi / 2].
double cosine_at_most(double angle) {
    const double square = angle * angle;
    return 1 - square / 2 + square * square / 24;
}

struct Visit {
    std::uint32_t node;
    std::uint32_t level;
    bool inside;          // its disks are wholly in the frustum
    bool chosen = false;  // a patch of which surfels are to be drawn
};

class Walk {
  public:
    Walk(const PointHierarchy& hierarchy, const CutView& view) : hierarchy_(hierarchy), view_(view) {
        const double inverse = 1 / view.scale;
        const auto row = [&](int r) {
            return glm::dvec4(view.model_to_view[0][r], view.model_to_view[1][r], view.model_to_view[2][r],
                              view.model_to_view[3][r]) *
                   inverse;
        };
        const glm::dvec4 right = row(0), up = row(1), depth = -row(2);
        depth_ = depth;
        // Distances beyond the four sides, in units that make them lengths.
        const auto side = [&](const glm::dvec4& across, double half) {
            if (view.orthographic) return across - glm::dvec4(0, 0, 0, half * inverse);
            return (across - half * depth) / std::hypot(1.0, half);
        };
        sides_ = {side(right, view.half_x), side(-right, view.half_x), side(up, view.half_y), side(-up, view.half_y)};
        near_ = view.near_plane * inverse;
        slack_ = kPrefilterReach / view.pixel_scale * (view.orthographic ? inverse : 1.0);
        eye_ = -(right.w * glm::dvec3(right) + up.w * glm::dvec3(up) + depth.w * glm::dvec3(depth));
        pixels_ = view.pixel_scale * (view.orthographic ? view.scale : 1.0);
        point_stretch_ = view.orthographic ? 1 : 1 + std::max(view.half_x, view.half_y);
    }

    void run(const Visit& root, LodCut& cut) const {
        std::vector<Visit> stack{root};
        while (!stack.empty()) {
            const Visit visit = stack.back();
            stack.pop_back();
            bool inside = false;
            if (!decide(visit, inside, cut)) continue;
            const format::PointNode& node = hierarchy_.nodes[visit.node];
            for (std::uint32_t child = node.child_count; child-- > 0;)
                stack.push_back({node.first_child + child, visit.level + 1, inside});
        }
    }

    // True if the children are to be visited; else what is drawn of the node, if anything, is in the cut.
    bool decide(const Visit& visit, bool& inside, LodCut& cut) const {
        const format::PointNode& node = hierarchy_.nodes[visit.node];
        ++cut.statistics.visited;
        const glm::dvec3 centre = position_of(node);
        const auto radius = static_cast<double>(node.sphere_radius);
        const double depth = glm::dot(glm::dvec3(depth_), centre) + depth_.w;
        inside = visit.inside;
        if (!inside) {
            if (outside(centre, depth, radius, inside)) {
                ++cut.statistics.outside_frustum;
                return false;
            }
        }
        if (!view_.two_sided && faces_away(node, centre, radius)) {
            ++cut.statistics.facing_away;
            return false;
        }
        const double magnification = pixels_at(centre, depth - radius);
        if (node.surfel_count > 1 && static_cast<double>(extent_of(node)) * magnification <= view_.tau) {
            ++cut.statistics.ellipses;
            cut.statistics.merged_surfels += node.surfel_count;
            append(cut, {visit.node, 1, true, fits_point(inside, radius, depth - radius), visit.level});
            return false;
        }
        if (!visit.chosen && !view_.triangle_costs.empty() && hierarchy_.patch[visit.node] != kNoPatch) {
            choose(visit, cut);
            return false;
        }
        const double reach = std::min(radius, static_cast<double>(hierarchy_.largest_radius));
        const bool fits = fits_point(inside, reach, depth - radius);
        // Where nothing below is small enough from anywhere, either, there is nothing left to decide.
        const bool full =
            inside && fits && (view_.two_sided || node.surfel_count <= kHardlyAway) &&
            static_cast<double>(hierarchy_.finest[visit.node]) * pixels_at_farthest(depth + radius) > view_.tau;
        if (!full && node.child_count != 0) return true;
        cut.statistics.surfels += node.surfel_count;
        append(cut, {node.first_surfel, node.surfel_count, false, fits, 0});
        return false;
    }

  private:
    // Triangles or surfels for the patch of a node.
    void choose(const Visit& visit, LodCut& cut) const {
        const std::uint32_t patch = hierarchy_.patch[visit.node];
        const double cost = view_.triangle_costs[patch];
        LodCut own;
        const bool clear = cost < 1;  // surfels would be one at least
        if (!clear) {
            run({visit.node, visit.level, visit.inside, true}, own);
            --own.statistics.visited;  // twice the patch itself
        }
        const CutStatistics& counts = own.statistics;
        if (!clear && cost >= static_cast<double>(counts.ellipses + counts.surfels)) {
            for (const CutRun& run : own.runs)
                append(cut, run);
            cut.statistics += counts;
            return;
        }
        cut.triangle_patches.push_back(patch);
        cut.statistics.visited += counts.visited;
        ++cut.statistics.patches_by_triangles;
    }

    bool outside(const glm::dvec3& centre, double depth, double radius, bool& inside) const {
        const double slack = slack_ * (view_.orthographic ? 1 : std::max(depth + radius, 0.0));
        double farthest = near_ - depth;
        if (farthest > radius) return true;
        for (const glm::dvec4& side : sides_) {
            const double beyond = glm::dot(glm::dvec3(side), centre) + side.w;
            if (beyond > radius + slack) return true;
            farthest = std::max(farthest, beyond);
        }
        inside = farthest < -radius;
        return false;
    }

    // beta + theta + alpha < 90 degrees (figure 11 b), and some for what shaders draw beyond the horizon.
    bool faces_away(const format::PointNode& node, const glm::dvec3& centre, double radius) const {
        constexpr double kRounding = 1e-3;  // radians; normals are quantised
        static const double kLimit = std::acos(-kHorizon) - kRounding;
        glm::dvec3 away = glm::dvec3(depth_);
        double alpha = 0;
        if (!view_.orthographic) {
            away = centre - eye_;
            const double distance = glm::length(away);
            if (distance <= radius) return false;
            away /= distance;
            alpha = std::numbers::pi / 2 * radius / distance;  // not below asin
        }
        const double limit = kLimit - alpha - node.cone_angle * (std::numbers::pi / kConeSteps);
        if (limit <= 0) return false;
        const auto normal = decode_octahedral(node.normal);
        const double cosine = static_cast<double>(normal[0]) * away.x + static_cast<double>(normal[1]) * away.y +
                              static_cast<double>(normal[2]) * away.z;
        return cosine > cosine_at_most(limit);
    }

    // How many pixels a unit-box unit may take at `centre`, nowhere nearer than `nearest`: the norm of the projection's
    // derivative, which is largest across the picture's middle.
    double pixels_at(const glm::dvec3& centre, double nearest) const {
        if (view_.orthographic) return pixels_;
        if (nearest <= near_) return std::numeric_limits<double>::infinity();
        return pixels_ * glm::length(centre - eye_) / (nearest * nearest);
    }

    // How many it takes at least, no farther than `farthest`.
    double pixels_at_farthest(double farthest) const { return view_.orthographic ? pixels_ : pixels_ / farthest; }

    bool fits_point(bool inside, double radius, double nearest) const {
        if (!inside) return false;
        const double stretch = view_.orthographic ? 1 : point_stretch_ / nearest;
        return 2 * (pixels_ * std::numbers::sqrt2 * radius * stretch + kPrefilterReach) <= view_.max_point_size;
    }

    static void append(LodCut& cut, const CutRun& run) {
        if (!cut.runs.empty()) {
            CutRun& last = cut.runs.back();
            if (last.inner == run.inner && last.fits_point == run.fits_point && last.level == run.level &&
                last.first + last.count == run.first) {
                last.count += run.count;
                return;
            }
        }
        cut.runs.push_back(run);
    }

    const PointHierarchy& hierarchy_;
    const CutView& view_;
    glm::dvec4 depth_;                 // of a point: dot(xyz, p) + w, unit-box units
    std::array<glm::dvec4, 4> sides_;  // the same of what it is beyond a side of the frustum
    glm::dvec3 eye_;
    double near_, slack_, pixels_, point_stretch_;
};

}  // namespace

CutStatistics& CutStatistics::operator+=(const CutStatistics& other) {
    visited += other.visited;
    outside_frustum += other.outside_frustum;
    facing_away += other.facing_away;
    ellipses += other.ellipses;
    merged_surfels += other.merged_surfels;
    surfels += other.surfels;
    patches_by_triangles += other.patches_by_triangles;
    return *this;
}

float extent_of(const format::PointNode& node) {
    return std::max(node.major, node.sphere_radius);
}

PointHierarchy point_hierarchy(std::span<const format::PointNode> nodes, std::span<const format::Patch> patches,
                               float largest_radius) {
    PointHierarchy hierarchy;
    hierarchy.nodes.assign(nodes.begin(), nodes.end());
    hierarchy.largest_radius = largest_radius;
    hierarchy.finest.resize(nodes.size());
    for (std::size_t i = nodes.size(); i-- > 0;) {
        const format::PointNode& node = nodes[i];
        float finest = node.surfel_count > 1 ? extent_of(node) : std::numeric_limits<float>::infinity();
        for (std::uint32_t child = 0; child < node.child_count; ++child)
            finest = std::min(finest, hierarchy.finest[node.first_child + child]);
        hierarchy.finest[i] = finest;
    }
    hierarchy.patch.assign(nodes.size(), kNoPatch);
    // Breadth first, so that of nodes with the same surfels the uppermost is found.
    std::vector<bool> found(patches.size(), false);
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        const auto next = std::upper_bound(
            patches.begin(), patches.end(), nodes[i].first_surfel,
            [](std::uint64_t surfel, const format::Patch& p) { return surfel < p.first_surfel + p.surfel_count; });
        if (next == patches.end() || next->first_surfel != nodes[i].first_surfel ||
            next->surfel_count != nodes[i].surfel_count)
            continue;
        const auto patch = static_cast<std::size_t>(next - patches.begin());
        if (!found[patch]) hierarchy.patch[i] = static_cast<std::uint32_t>(patch);
        found[patch] = true;
    }
    return hierarchy;
}

LodCut cut_points(const PointHierarchy& hierarchy, const CutView& view) {
    LodCut cut;
    if (hierarchy.empty()) return cut;
    const Walk walk(hierarchy, view);
    // What is decided and what is not yet, in order: cuts, each with the visit that comes after it.
    struct Task {
        LodCut before;
        Visit visit{};
        bool pending = false;
    };
    std::vector<Task> tasks(1);
    tasks.front() = {{}, {0, 1, false}, true};
    for (int round = 0; round < kMostRounds && tasks.size() < kTasks; ++round) {
        std::vector<Task> next;
        for (Task& task : tasks) {
            if (!task.pending) {
                next.push_back(std::move(task));
                continue;
            }
            bool inside = false;
            const bool descend = walk.decide(task.visit, inside, task.before);
            next.push_back({std::move(task.before), {}, false});
            if (!descend) continue;
            const format::PointNode& node = hierarchy.nodes[task.visit.node];
            for (std::uint32_t child = 0; child < node.child_count; ++child)
                next.push_back({{}, {node.first_child + child, task.visit.level + 1, inside}, true});
        }
        tasks = std::move(next);
    }
    tbb::parallel_for(std::size_t{0}, tasks.size(), [&](std::size_t i) {
        if (tasks[i].pending) walk.run(tasks[i].visit, tasks[i].before);
    });
    std::size_t runs = 0;
    for (const Task& task : tasks)
        runs += task.before.runs.size();
    cut.runs.reserve(runs);
    for (const Task& task : tasks) {
        cut.runs.insert(cut.runs.end(), task.before.runs.begin(), task.before.runs.end());
        cut.triangle_patches.insert(cut.triangle_patches.end(), task.before.triangle_patches.begin(),
                                    task.before.triangle_patches.end());
        cut.statistics += task.before.statistics;
    }
    return cut;
}

}  // namespace splice
