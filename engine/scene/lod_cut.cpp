// Pajarola et al. 2004, section 6.2. All in the model's unit-box space, where nodes need not be transformed. A node's
// children are looked at together, without a branch: what becomes of each is worked out from all tests at once, since
// what a test says is not to be guessed, and a wrong guess takes as long as the tests do. Single precision, with what
// it may be off by on the side of drawing.
#include "engine/scene/lod_cut.h"

#include "engine/scene/splat_reach.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

namespace splice {

namespace {

// Subtrees that are walked at once.
constexpr std::size_t kTasks = 64;
constexpr int kMostRounds = 8;
// Surfels that are not worth looking for nodes that face away.
constexpr std::uint32_t kHardlyAway = 256;

enum class Step : std::uint8_t { kDescend, kEllipse, kSurfels };

// A node that is in the cut, or of which something below is.
struct Visit {
    std::uint32_t node;
    std::uint32_t surfel_end;  // below it
    std::uint32_t level;
    Step step;
    bool inside;  // its disks are wholly in the frustum
    bool fits;    // CutRun::fits_point of what is drawn
    bool choose;  // between this and triangles
};

// Distances in three directions, and an offset: of a point, dot(xyz, p) + w.
struct Plane {
    float x, y, z, w;
};

Plane plane_of(const glm::dvec4& v) {
    return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z), static_cast<float>(v.w)};
}

// A figure of each child.
template <typename T>
using Lanes = std::array<T, kHierarchyLanes>;

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
        depth_ = plane_of(depth);
        // Distances beyond the four sides, in units that make them lengths.
        const auto side = [&](const glm::dvec4& across, double half) {
            if (view.orthographic) return plane_of(across - glm::dvec4(0, 0, 0, half * inverse));
            return plane_of((across - half * depth) / std::hypot(1.0, half));
        };
        sides_ = {side(right, view.half_x), side(-right, view.half_x), side(up, view.half_y), side(-up, view.half_y)};
        near_ = static_cast<float>(view.near_plane * inverse);
        const glm::dvec3 eye = -(right.w * glm::dvec3(right) + up.w * glm::dvec3(up) + depth.w * glm::dvec3(depth));
        eye_ = plane_of(glm::dvec4(eye, 0));
        // Coordinates are below 1, distances up to these: a few roundings of each.
        constexpr double kRoundings = 8 * 0x1p-24;
        rounding_ = static_cast<float>(kRoundings *
                                       (2 + glm::length(eye) + std::abs(right.w) + std::abs(up.w) + std::abs(depth.w)));
        slack_ = static_cast<float>(kPrefilterReach / view.pixel_scale * (view.orthographic ? inverse : 1.0));
        const double pixels = view.pixel_scale * (view.orthographic ? view.scale : 1.0);
        longest_ = static_cast<float>(view.tau / (2 * pixels) * (1 - 1e-6));
        const double stretch = view.orthographic ? 1 : 1 + std::max(view.half_x, view.half_y);
        largest_point_ =
            static_cast<float>((view.max_point_size / 2 - kPrefilterReach) / (pixels * std::numbers::sqrt2 * stretch));
        perspective_ = view.orthographic ? 0.0f : 1.0f;
    }

    // Of siblings, those that something is drawn of; how many.
    std::size_t decide(std::uint32_t first, std::size_t count, const Visit& parent, Lanes<Visit>& visits,
                       CutStatistics& statistics) const {
        const PointHierarchy& h = hierarchy_;
        const auto at = [&](const std::vector<float>& array) { return array.data() + first; };
        const float *const x = at(h.x), *const y = at(h.y), *const z = at(h.z), *const radius = at(h.radius),
                           *const extent = at(h.extent);
        Lanes<float> depth, distance2, beyond;
        for (std::size_t i = 0; i < kHierarchyLanes; ++i) {
            depth[i] = x[i] * depth_.x + y[i] * depth_.y + z[i] * depth_.z + depth_.w;
            const float dx = x[i] - eye_.x, dy = y[i] - eye_.y, dz = z[i] - eye_.z;
            distance2[i] = dx * dx + dy * dy + dz * dz;
        }
        Lanes<std::uint8_t> outside{}, inside, away{}, small, fits_whole, fits_disks, coarse;
        if (parent.inside) {
            inside.fill(1);
        } else {
            beyond.fill(-std::numeric_limits<float>::infinity());
            for (const Plane& side : sides_)
                for (std::size_t i = 0; i < kHierarchyLanes; ++i)
                    beyond[i] = std::max(beyond[i], x[i] * side.x + y[i] * side.y + z[i] * side.z + side.w);
            for (std::size_t i = 0; i < kHierarchyLanes; ++i) {
                const float before = near_ - depth[i];
                const float slack =
                    slack_ * (1 - perspective_ + perspective_ * std::max(depth[i] + radius[i], 0.0f)) + rounding_;
                outside[i] =
                    static_cast<std::uint8_t>((before > radius[i] + rounding_) | (beyond[i] > radius[i] + slack));
                inside[i] = static_cast<std::uint8_t>(std::max(before, beyond[i]) < -radius[i] - rounding_);
            }
        }
        if (!view_.two_sided) faces_away(first, distance2, away);
        const float longest2 = longest_ * longest_, largest = h.largest_radius;
        const float* const finest = at(h.finest);
        for (std::size_t i = 0; i < kHierarchyLanes; ++i) {
            // A length takes at most so many pixels per unit wherever around the node it is: distance / nearest^2, the
            // norm of the projection's derivative, which is largest across the picture's middle.
            const float nearest = depth[i] - radius[i];
            const float scale = 1 - perspective_ + perspective_ * nearest;
            const float most = longest2 * scale * scale;
            const float stretch =
                1 - perspective_ + perspective_ * (distance2[i] / std::max(nearest * nearest, near_ * near_));
            small[i] = static_cast<std::uint8_t>((perspective_ * nearest > near_ * perspective_ - (1 - perspective_)) &
                                                 (extent[i] * extent[i] * stretch <= most));
            const float point = largest_point_ * scale;
            fits_whole[i] = static_cast<std::uint8_t>(radius[i] <= point);
            fits_disks[i] = static_cast<std::uint8_t>(std::min(radius[i], largest) <= point);
            // Nothing below is small enough from anywhere.
            coarse[i] = static_cast<std::uint8_t>(
                finest[i] > longest_ * (1 - perspective_ + perspective_ * (depth[i] + radius[i])));
        }
        std::size_t kept = 0;
        statistics.visited += count;
        for (std::size_t i = 0; i < count; ++i) {
            const auto node = static_cast<std::uint32_t>(first + i);
            const std::uint8_t below = h.below[node];
            statistics.outside_frustum += outside[i];
            statistics.facing_away += static_cast<std::uint8_t>(away[i] & (outside[i] ^ 1));
            const std::uint32_t end = i + 1 < count ? h.first_surfel[node + 1] : parent.surfel_end;
            const std::uint32_t surfels = end - h.first_surfel[node];
            const bool in = inside[i] != 0;
            const bool full =
                in & (fits_disks[i] != 0) & (view_.two_sided | (surfels <= kHardlyAway)) & (coarse[i] != 0);
            const bool leaf = (below & PointHierarchy::kChildren) == 0;
            const bool ellipse = small[i] != 0;
            const Step step = ellipse ? Step::kEllipse : full | leaf ? Step::kSurfels : Step::kDescend;
            const std::uint8_t fits = ellipse ? fits_whole[i] : fits_disks[i];
            const bool choose = ((below & PointHierarchy::kIsPatch) != 0) & !ellipse & !view_.triangle_costs.empty();
            visits[kept] = {node, end, parent.level + 1, step, in, in && fits != 0, choose};
            kept += (outside[i] | away[i]) == 0 ? 1 : 0;
        }
        return kept;
    }

    std::uint32_t patch_of(std::uint32_t node) const {
        return std::lower_bound(hierarchy_.patches.begin(), hierarchy_.patches.end(), std::pair{node, 0U})->second;
    }
    double triangle_cost(std::uint32_t patch) const { return view_.triangle_costs[patch]; }
    const PointHierarchy& hierarchy() const { return hierarchy_; }

  private:
    // beta + theta + alpha < 90 degrees (figure 11 b), and some for what shaders draw beyond the horizon: with L what
    // the cone leaves of that, alpha < L and cos beta > cos(L - alpha), times the distance.
    void faces_away(std::uint32_t first, const Lanes<float>& distance2, Lanes<std::uint8_t>& away) const {
        const PointHierarchy& h = hierarchy_;
        const auto at = [&](const std::vector<float>& array) { return array.data() + first; };
        const float *const x = at(h.x), *const y = at(h.y), *const z = at(h.z), *const radius = at(h.radius),
                           *const nx = at(h.nx), *const ny = at(h.ny), *const nz = at(h.nz),
                           *const cosine = at(h.left_cosine), *const sine = at(h.left_sine);
        if (view_.orthographic) {
            for (std::size_t i = 0; i < kHierarchyLanes; ++i)
                away[i] = static_cast<std::uint8_t>(nx[i] * depth_.x + ny[i] * depth_.y + nz[i] * depth_.z > cosine[i]);
            return;
        }
        for (std::size_t i = 0; i < kHierarchyLanes; ++i) {
            const float along = nx[i] * (x[i] - eye_.x) + ny[i] * (y[i] - eye_.y) + nz[i] * (z[i] - eye_.z);
            const float radius2 = radius[i] * radius[i];
            const float behind = along - sine[i] * radius[i];
            away[i] = static_cast<std::uint8_t>((sine[i] * sine[i] * distance2[i] > radius2) & (behind > 0) &
                                                (behind * behind > cosine[i] * cosine[i] * (distance2[i] - radius2)));
        }
    }

    const PointHierarchy& hierarchy_;
    const CutView& view_;
    Plane depth_;                 // unit-box units
    std::array<Plane, 4> sides_;  // of what is beyond a side of the frustum
    Plane eye_;
    float near_, slack_;
    float rounding_;
    float longest_;        // half axis that takes tau pixels at depth 1, or anywhere
    float largest_point_;  // radius of a disk that fits the largest point there
    float perspective_;    // 1, or 0 of parallel rays
};

// One subtree, depth first.
class Walk {
  public:
    Walk(const Rules& rules, LodCut& cut) : rules_(rules), cut_(cut) {}

    void run(const Visit& root) { run(root, std::numeric_limits<double>::infinity()); }

  private:
    // Triangles or surfels for the patch of a node.
    void choose(Visit visit) {
        const std::uint32_t patch = rules_.patch_of(visit.node);
        const double cost = rules_.triangle_cost(patch);
        const CutStatistics before = cut_.statistics;
        const std::size_t runs = cut_.runs.size();
        const CutRun last = runs == 0 ? CutRun{} : cut_.runs.back();
        visit.choose = false;
        // Surfels would be one at least.
        if (cost >= 1 && run(visit, elements(before) + cost)) return;
        const std::uint64_t visited = cut_.statistics.visited;
        cut_.runs.resize(runs);
        if (runs != 0) cut_.runs.back() = last;
        cut_.statistics = before;
        cut_.statistics.visited = visited;
        ++cut_.statistics.patches_by_triangles;
        cut_.triangle_patches.push_back(patch);
    }

    static double elements(const CutStatistics& counts) {
        return static_cast<double>(counts.ellipses + counts.surfels);
    }

    // False if it ended because the cut has more than `most` elements.
    bool run(const Visit& root, double most) {
        const std::size_t base = stack_.size();
        stack_.push_back(root);
        Lanes<Visit> children;
        while (stack_.size() > base) {
            const Visit visit = stack_.back();
            stack_.pop_back();
            if (visit.choose) {
                choose(visit);
                continue;
            }
            if (visit.step == Step::kDescend) {
                for (std::size_t i =
                         rules_.decide(rules_.hierarchy().first_child[visit.node],
                                       rules_.hierarchy().child_count(visit.node), visit, children, cut_.statistics);
                     i-- > 0;)
                    stack_.push_back(children[i]);
                continue;
            }
            draw(visit);
            if (elements(cut_.statistics) > most) {
                stack_.resize(base);
                return false;
            }
        }
        return true;
    }

    void draw(const Visit& visit) {
        const std::uint32_t first = rules_.hierarchy().first_surfel[visit.node], surfels = visit.surfel_end - first;
        if (visit.step == Step::kEllipse) {
            ++cut_.statistics.ellipses;
            cut_.statistics.merged_surfels += surfels;
            append({visit.node, 1, true, visit.fits, visit.level});
        } else {
            cut_.statistics.surfels += surfels;
            append({first, surfels, false, visit.fits, 0});
        }
    }

    void append(const CutRun& run) {
        if (!cut_.runs.empty()) {
            CutRun& last = cut_.runs.back();
            if (last.inner == run.inner && last.fits_point == run.fits_point && last.level == run.level &&
                last.first + last.count == run.first) {
                last.count += run.count;
                return;
            }
        }
        cut_.runs.push_back(run);
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
    return *this;
}

LodCut cut_points(const PointHierarchy& hierarchy, const CutView& view) {
    LodCut cut;
    if (hierarchy.empty()) return cut;
    const Rules rules(hierarchy, view);
    const Visit above{0, hierarchy.surfel_counts[0], 0, Step::kDescend, false, false, false};
    Lanes<Visit> decided;
    std::vector<Visit> visits(decided.begin(), decided.begin() + static_cast<std::ptrdiff_t>(rules.decide(
                                                                     0, 1, above, decided, cut.statistics)));
    // From above, until there are subtrees enough, in order.
    for (int round = 0; round < kMostRounds && visits.size() < kTasks; ++round) {
        std::vector<Visit> next;
        for (const Visit& visit : visits) {
            if (visit.choose || visit.step != Step::kDescend) {
                next.push_back(visit);
                continue;
            }
            const std::size_t kept = rules.decide(hierarchy.first_child[visit.node], hierarchy.child_count(visit.node),
                                                  visit, decided, cut.statistics);
            next.insert(next.end(), decided.begin(), decided.begin() + static_cast<std::ptrdiff_t>(kept));
        }
        visits = std::move(next);
    }
    std::vector<LodCut> parts(visits.size());
    tbb::parallel_for(std::size_t{0}, parts.size(), [&](std::size_t i) { Walk(rules, parts[i]).run(visits[i]); });
    std::size_t runs = 0;
    for (const LodCut& part : parts)
        runs += part.runs.size();
    cut.runs.reserve(runs);
    for (const LodCut& part : parts) {
        cut.runs.insert(cut.runs.end(), part.runs.begin(), part.runs.end());
        cut.triangle_patches.insert(cut.triangle_patches.end(), part.triangle_patches.begin(),
                                    part.triangle_patches.end());
        cut.statistics += part.statistics;
    }
    return cut;
}

}  // namespace splice
