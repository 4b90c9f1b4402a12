// Pajarola et al. 2004, section 6.2. All in the model's unit-box space, where nodes need not be transformed. A visit
// takes no division and no angle: what the paper compares is multiplied out.
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

constexpr std::size_t kConeSteps = 255;  // format::PointNode::cone_angle
// Subtrees that are walked at once.
constexpr std::size_t kTasks = 64;
constexpr int kMostRounds = 8;
// Surfels that are not worth looking for nodes that face away.
constexpr std::uint32_t kHardlyAway = 256;

struct Visit {
    std::uint32_t node;
    std::uint32_t level;
    bool inside;          // its disks are wholly in the frustum
    bool chosen = false;  // a patch of which surfels are to be drawn
};

// How far the axis of a cone may be from the eye's side: the cosine and sine of what is left between the cone's rim and
// the horizon.
struct Limit {
    double cosine = 2, sine = 0;  // never
};

// Indexed by cone_angle.
std::array<Limit, kConeSteps + 1> cone_limits() {
    constexpr double kRounding = 1e-3;  // radians; normals are quantised
    const double horizon = std::acos(-kHorizon) - kRounding;
    std::array<Limit, kConeSteps + 1> limits;
    for (std::size_t step = 0; step <= kConeSteps; ++step) {
        const double left = horizon - static_cast<double>(step) * (std::numbers::pi / kConeSteps);
        if (left > 0) limits[step] = {std::cos(left), std::sin(left)};
    }
    return limits;
}

// What all visits of a walk share.
class Rules {
  public:
    Rules(const PointHierarchy& hierarchy, const CutView& view) : hierarchy_(hierarchy), view_(view) {
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
        const double pixels = view.pixel_scale * (view.orthographic ? view.scale : 1.0);
        longest_ = view.tau / (2 * pixels);
        const double stretch = view.orthographic ? 1 : 1 + std::max(view.half_x, view.half_y);
        largest_point_ = (view.max_point_size / 2 - kPrefilterReach) / (pixels * std::numbers::sqrt2 * stretch);
    }

    enum class Step { kEnd, kDescend, kChoose };

    // What becomes of a node; where it ends the walk, what is drawn of it is in the cut.
    Step decide(const Visit& visit, bool& inside, LodCut& cut) const {
        const CutNode& node = hierarchy_.nodes[visit.node];
        ++cut.statistics.visited;
        const glm::dvec3 centre(node.centre[0], node.centre[1], node.centre[2]);
        const auto radius = static_cast<double>(node.radius);
        const double depth = glm::dot(glm::dvec3(depth_), centre) + depth_.w;
        inside = visit.inside;
        const Left left = left_of(visit.node);
        if (left == Left::kNone) return Step::kEnd;
        if (!inside && outside(centre, depth, radius, inside)) {
            ++cut.statistics.outside_frustum;
            return Step::kEnd;
        }
        const glm::dvec3 from_eye = centre - eye_;
        const double distance2 = glm::dot(from_eye, from_eye);
        const CutNodeDetail& detail = hierarchy_.details[visit.node];
        if (!view_.two_sided && faces_away(detail, from_eye, distance2, radius)) {
            ++cut.statistics.facing_away;
            return Step::kEnd;
        }
        if (left == Left::kSome) return Step::kDescend;
        const std::uint32_t surfels = hierarchy_.surfel_counts[visit.node];
        const double nearest = depth - radius;
        if (small_enough(static_cast<double>(node.extent), nearest, distance2)) {
            ++cut.statistics.ellipses;
            cut.statistics.merged_surfels += surfels;
            append(cut, {visit.node, 1, true, fits_point(inside, radius, nearest), visit.level});
            return Step::kEnd;
        }
        if (detail.is_patch && !visit.chosen && !view_.triangle_costs.empty()) return Step::kChoose;
        const double reach = std::min(radius, static_cast<double>(hierarchy_.largest_radius));
        const bool fits = fits_point(inside, reach, nearest);
        // Where nothing below is small enough from anywhere, either, there is nothing left to decide.
        const bool full = inside && fits && (view_.two_sided || surfels <= kHardlyAway) &&
                          static_cast<double>(node.finest) > longest_ * (view_.orthographic ? 1 : depth + radius);
        if (!full && detail.child_count != 0) return Step::kDescend;
        cut.statistics.surfels += surfels;
        append(cut, {node.first_surfel, surfels, false, fits, 0});
        return Step::kEnd;
    }

    std::uint32_t patch_of(std::uint32_t node) const {
        return std::lower_bound(hierarchy_.patches.begin(), hierarchy_.patches.end(), std::pair{node, 0U})->second;
    }
    double triangle_cost(std::uint32_t patch) const { return view_.triangle_costs[patch]; }
    const PointHierarchy& hierarchy() const { return hierarchy_; }

  private:
    enum class Left { kAll, kSome, kNone };

    // Of a node's surfels, but for CutView::left_out.
    Left left_of(std::uint32_t node) const {
        if (view_.left_out.empty()) return Left::kAll;
        const std::uint32_t first = hierarchy_.nodes[node].first_surfel, end = first + hierarchy_.surfel_counts[node];
        const auto next =
            std::ranges::upper_bound(view_.left_out, first, {}, [](const auto& range) { return range.second; });
        if (next == view_.left_out.end() || next->first >= end) return Left::kAll;
        return next->first <= first && next->second >= end ? Left::kNone : Left::kSome;
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

    // beta + theta + alpha < 90 degrees (figure 11 b), and some for what shaders draw beyond the horizon: with L what
    // the cone leaves of that, alpha < L and cos beta > cos(L - alpha), times the distance.
    bool faces_away(const CutNodeDetail& node, const glm::dvec3& from_eye, double distance2, double radius) const {
        static const std::array<Limit, kConeSteps + 1> limits = cone_limits();
        const Limit& limit = limits[node.cone_angle];
        const glm::dvec3 normal(node.normal[0], node.normal[1], node.normal[2]);
        if (view_.orthographic) return glm::dot(normal, glm::dvec3(depth_)) > limit.cosine;
        const double radius2 = radius * radius;
        if (limit.sine * limit.sine * distance2 <= radius2) return false;
        const double beyond = glm::dot(normal, from_eye) - limit.sine * radius;
        return beyond > 0 && beyond * beyond > limit.cosine * limit.cosine * (distance2 - radius2);
    }

    // Whether a length takes at most tau pixels wherever around the node it is. A unit takes that many times
    // distance / nearest^2 there, the norm of the projection's derivative, which is largest across the picture's
    // middle.
    bool small_enough(double extent, double nearest, double distance2) const {
        if (view_.orthographic) return extent <= longest_;
        const double most = longest_ * nearest * nearest;
        return nearest > near_ && extent * extent * distance2 <= most * most;
    }

    bool fits_point(bool inside, double radius, double nearest) const {
        return inside && radius <= largest_point_ * (view_.orthographic ? 1 : nearest);
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
    double near_, slack_;
    double longest_;        // half axis that takes tau pixels at depth 1, or anywhere
    double largest_point_;  // radius of a disk that fits the largest point there
};

// One subtree, depth first.
class Walk {
  public:
    Walk(const Rules& rules, LodCut& cut) : rules_(rules), cut_(cut) {}

    void run(const Visit& root) { run(root, std::numeric_limits<double>::infinity()); }

    // Triangles or surfels for the patch of a node.
    void choose(const Visit& visit) {
        const std::uint32_t patch = rules_.patch_of(visit.node);
        const double cost = rules_.triangle_cost(patch);
        const CutStatistics before = cut_.statistics;
        const std::size_t runs = cut_.runs.size();
        const CutRun last = runs == 0 ? CutRun{} : cut_.runs.back();
        // Surfels would be one at least.
        const bool within = cost >= 1 && run({visit.node, visit.level, visit.inside, true}, elements(before) + cost);
        // The patch itself was visited twice.
        const std::uint64_t visited = cut_.statistics.visited - (cost >= 1 ? 1 : 0);
        if (!within) {
            cut_.runs.resize(runs);
            if (runs != 0) cut_.runs.back() = last;
            cut_.statistics = before;
            cut_.triangle_patches.push_back(patch);
            ++cut_.statistics.patches_by_triangles;
        }
        cut_.statistics.visited = visited;
    }

  private:
    static double elements(const CutStatistics& counts) {
        return static_cast<double>(counts.ellipses + counts.surfels);
    }

    // False if it ended because the cut has more than `most` elements.
    bool run(const Visit& root, double most) {
        const std::size_t base = stack_.size();
        stack_.push_back(root);
        while (stack_.size() > base) {
            const Visit visit = stack_.back();
            stack_.pop_back();
            bool inside = false;
            const Rules::Step step = rules_.decide(visit, inside, cut_);
            if (step == Rules::Step::kChoose) {
                choose({visit.node, visit.level, inside});
            } else if (step == Rules::Step::kDescend) {
                const std::uint32_t first = rules_.hierarchy().nodes[visit.node].first_child;
                for (std::uint32_t child = rules_.hierarchy().details[visit.node].child_count; child-- > 0;)
                    stack_.push_back({first + child, visit.level + 1, inside, visit.chosen});
            } else if (elements(cut_.statistics) > most) {
                stack_.resize(base);
                return false;
            }
        }
        return true;
    }

    const Rules& rules_;
    LodCut& cut_;
    std::vector<Visit> stack_;
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
    groups_by_triangles += other.groups_by_triangles;
    return *this;
}

float extent_of(const format::PointNode& node) {
    return std::max(node.major, node.sphere_radius);
}

PointHierarchy point_hierarchy(std::span<const format::PointNode> nodes, std::span<const format::Patch> patches,
                               float largest_radius) {
    PointHierarchy hierarchy;
    hierarchy.largest_radius = largest_radius;
    hierarchy.nodes.resize(nodes.size());
    hierarchy.details.resize(nodes.size());
    hierarchy.surfel_counts.resize(nodes.size());
    for (std::size_t i = nodes.size(); i-- > 0;) {
        const format::PointNode& node = nodes[i];
        const float extent = node.surfel_count > 1 ? extent_of(node) : std::numeric_limits<float>::infinity();
        float finest = extent;
        for (std::uint32_t child = 0; child < node.child_count; ++child)
            finest = std::min(finest, hierarchy.nodes[node.first_child + child].finest);
        hierarchy.nodes[i] = {{node.position[0], node.position[1], node.position[2]},
                              node.sphere_radius,
                              extent,
                              finest,
                              node.first_child,
                              node.first_surfel};
        const std::array<float, 3> normal = decode_octahedral(node.normal);
        hierarchy.details[i] = {{normal[0], normal[1], normal[2]}, node.cone_angle, node.child_count, false, 0};
        hierarchy.surfel_counts[i] = node.surfel_count;
    }
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
        if (!found[patch]) {
            hierarchy.patches.emplace_back(static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(patch));
            hierarchy.details[i].is_patch = true;
        }
        found[patch] = true;
    }
    return hierarchy;
}

LodCut cut_points(const PointHierarchy& hierarchy, const CutView& view) {
    LodCut cut;
    if (hierarchy.empty()) return cut;
    const Rules rules(hierarchy, view);
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
            const Rules::Step step = rules.decide(task.visit, inside, task.before);
            if (step == Rules::Step::kChoose)
                Walk(rules, task.before).choose({task.visit.node, task.visit.level, inside});
            next.push_back({std::move(task.before), {}, false});
            if (step != Rules::Step::kDescend) continue;
            const std::uint32_t first = hierarchy.nodes[task.visit.node].first_child;
            for (std::uint32_t child = 0; child < hierarchy.details[task.visit.node].child_count; ++child)
                next.push_back({{}, {first + child, task.visit.level + 1, inside}, true});
        }
        tasks = std::move(next);
    }
    tbb::parallel_for(std::size_t{0}, tasks.size(), [&](std::size_t i) {
        if (tasks[i].pending) Walk(rules, tasks[i].before).run(tasks[i].visit);
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
