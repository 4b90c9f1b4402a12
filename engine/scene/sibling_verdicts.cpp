// Compiled without contraction to fused multiply-adds, so that every processor decides the same.
#include "engine/scene/sibling_verdicts.h"

#include "engine/scene/splat_reach.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <numbers>

namespace splice {

SiblingJudge::Plane::Plane(const glm::dvec4& plane)
    : normal{spread(plane.x), spread(plane.y), spread(plane.z)}, w(spread(plane.w)) {}

SiblingJudge::Floats SiblingJudge::Plane::distance(const Points& p) const {
    return normal.x * p.x + normal.y * p.y + (normal.z * p.z + w);
}

SiblingJudge::Floats SiblingJudge::spread(double value) {
    return Floats{} + static_cast<float>(value);
}

SiblingJudge::Floats SiblingJudge::larger(Floats a, Floats b) {
    return a > b ? a : b;
}

SiblingJudge::Floats SiblingJudge::dot(const Points& a, const Points& b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

SiblingJudge::SiblingJudge(const PointHierarchy& hierarchy, const CutView& view)
    : hierarchy_(hierarchy), orthographic_(view.orthographic), two_sided_(view.two_sided) {
    const double inverse = 1 / view.scale;
    const auto row = [&](int r) {
        return glm::dvec4(view.model_to_view[0][r], view.model_to_view[1][r], view.model_to_view[2][r],
                          view.model_to_view[3][r]) *
               inverse;
    };
    const glm::dvec4 right = row(0), up = row(1), depth = -row(2);
    depth_ = Plane(depth);
    // Distances beyond the four sides, in units that make them lengths.
    const auto side = [&](const glm::dvec4& across, double half) {
        if (view.orthographic) return across - glm::dvec4(0, 0, 0, half * inverse);
        return (across - half * depth) / std::hypot(1.0, half);
    };
    const std::array<glm::dvec4, 4> sides{side(right, view.half_x), side(-right, view.half_x), side(up, view.half_y),
                                          side(-up, view.half_y)};
    double farthest = std::abs(depth.w);
    for (std::size_t i = 0; i < sides.size(); ++i) {
        sides_[i] = Plane(sides[i]);
        farthest = std::max(farthest, std::abs(sides[i].w));
    }
    // Four products and as many sums of what is at most `farthest` or, in the unit box, sqrt(3).
    constexpr double kRoundings = 8 * static_cast<double>(std::numeric_limits<float>::epsilon());
    rounding_ = spread(kRoundings * (farthest + 2));
    near_ = spread(view.near_plane * inverse);
    slack_ = spread(kPrefilterReach / view.pixel_scale * (view.orthographic ? inverse : 1.0));
    const glm::dvec3 eye = -(right.w * glm::dvec3(right) + up.w * glm::dvec3(up) + depth.w * glm::dvec3(depth));
    eye_ = {spread(eye.x), spread(eye.y), spread(eye.z)};
    const double pixels = view.pixel_scale * (view.orthographic ? view.scale : 1.0);
    longest_ = spread(view.tau / (2 * pixels));
    const double stretch = view.orthographic ? 1 : 1 + std::max(view.half_x, view.half_y);
    largest_point_ = spread((view.max_point_size / 2 - kPrefilterReach) / (pixels * std::numbers::sqrt2 * stretch));
    largest_radius_ = spread(static_cast<double>(hierarchy.largest_radius));
}

template <bool orthographic>
SiblingVerdicts SiblingJudge::judge_lanes(std::size_t first) const {
    const auto load = [&](const std::vector<float>& values) {
        Floats lanes;
        std::memcpy(&lanes, values.data() + first, sizeof(lanes));
        return lanes;
    };
    // Lane i's is bit i of a byte.
    const auto bits_at = [](int byte, Bits condition) { return condition & (Bits{1, 2, 4, 8} << (8 * byte)); };
    const auto together = [](Bits bits) { return static_cast<std::uint32_t>(bits[0] | bits[1] | bits[2] | bits[3]); };
    const Points centre{load(hierarchy_.x), load(hierarchy_.y), load(hierarchy_.z)};
    const Floats radius = load(hierarchy_.radius);
    const Floats depth = depth_.distance(centre);
    const Floats before = near_ - depth;
    const Floats beyond = larger(larger(sides_[0].distance(centre), sides_[1].distance(centre)),
                                 larger(sides_[2].distance(centre), sides_[3].distance(centre)));
    const Floats nothing{};
    const Floats slack = orthographic ? slack_ : slack_ * larger(depth + radius, nothing);
    const Bits outside = (before > radius + rounding_) | (beyond > radius + slack + rounding_);
    const Bits inside = larger(before, beyond) < -radius - rounding_;

    const Points from_eye{centre.x - eye_.x, centre.y - eye_.y, centre.z - eye_.z};
    const Floats squared = dot(from_eye, from_eye);
    const Floats nearest = depth - radius, extent = load(hierarchy_.extent);
    // A length takes at most tau pixels wherever around the node it is. A unit takes that many times
    // distance / nearest^2 there, the norm of the projection's derivative, which is largest across the picture's
    // middle.
    const Floats most = longest_ * nearest * nearest;
    const Bits small =
        orthographic ? extent <= longest_ : (nearest > near_) & (extent * extent * squared <= most * most);
    const Floats point = orthographic ? largest_point_ : largest_point_ * nearest;
    const Bits narrow = radius <= point, fine = (radius < largest_radius_ ? radius : largest_radius_) <= point;
    const Floats finest = load(hierarchy_.finest);
    const Bits never = orthographic ? finest > longest_ : finest > longest_ * (depth + radius);
    const Bits ends = bits_at(0, outside) | bits_at(2, small) | bits_at(3, inside);
    const Bits sizes = bits_at(0, narrow) | bits_at(1, fine) | bits_at(2, never);
    if (two_sided_) return {together(ends), together(sizes)};

    // beta + theta + alpha < 90 degrees (figure 11 b), and some for what shaders draw beyond the horizon: with L what
    // the cone leaves of that, alpha < L and cos beta > cos(L - alpha), times the distance.
    const Points normal{load(hierarchy_.normal_x), load(hierarchy_.normal_y), load(hierarchy_.normal_z)};
    const Floats cosine = load(hierarchy_.to_horizon), sine = load(hierarchy_.sine_to_horizon);
    if constexpr (orthographic) {
        return {together(ends | bits_at(1, dot(normal, depth_.normal) > cosine)), together(sizes)};
    } else {
        const Floats radius2 = radius * radius, along = dot(normal, from_eye) - sine * radius;
        const Bits away =
            (sine * sine * squared > radius2) & (along > 0) & (along * along > cosine * cosine * (squared - radius2));
        return {together(ends | bits_at(1, away)), together(sizes)};
    }
}

SiblingVerdicts SiblingJudge::judge(std::uint32_t first, std::uint32_t count) const {
    const auto lanes = [&](std::size_t at) { return orthographic_ ? judge_lanes<true>(at) : judge_lanes<false>(at); };
    SiblingVerdicts verdicts = lanes(first);
    if (count > kLanes) {
        const SiblingVerdicts others = lanes(first + kLanes);
        verdicts.ends |= others.ends << kLanes;
        verdicts.sizes |= others.sizes << kLanes;
    }
    return verdicts;
}

}  // namespace splice
