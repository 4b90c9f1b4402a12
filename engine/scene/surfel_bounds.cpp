// Cones and balls against an eye: Shirman & Abi-Ezzi 1993, "The cone of normals technique"; Pajarola et al. 2004,
// section 6.2.
#include "engine/scene/surfel_bounds.h"

#include "preprocess/model_format/half.h"
#include "preprocess/model_format/octahedral.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace splice {

namespace {

// Of directions, radians: normals are quantised and, as positions, handled in single precision.
constexpr double kSlack = 1e-3;
// Of positions, as a share of the lengths that are added up to get them.
constexpr double kRounding = 1e-6;

glm::dvec3 vector_of(const float (&v)[3]) {
    return {v[0], v[1], v[2]};
}

glm::dvec3 normal_of(const format::Surfel& surfel) {
    const std::array<float, 3> n = decode_octahedral(surfel.normal);
    return {n[0], n[1], n[2]};
}

SurfelBounds bound(std::span<const format::Surfel> surfels) {
    glm::dvec3 low(std::numeric_limits<double>::infinity()), high(-low), normals(0);
    double largest = 0;
    bool known = true;
    for (const format::Surfel& surfel : surfels) {
        const glm::dvec3 position = vector_of(surfel.position);
        const double radius = std::abs(static_cast<double>(float_from_half(surfel.radius)));
        known = known && std::isfinite(position.x + position.y + position.z + radius);
        low = glm::min(low, position);
        high = glm::max(high, position);
        normals += normal_of(surfel);
        largest = std::max(largest, radius);
    }
    SurfelBounds bounds;
    if (!known) {
        bounds.radius = std::numeric_limits<float>::infinity();
        return bounds;
    }
    bounds.centre = glm::vec3(0.5 * (low + high));
    bounds.largest = static_cast<float>(largest);
    if (glm::length(normals) > 0) bounds.axis = glm::vec3(glm::normalize(normals));
    double radius = 0, cosine = 1;
    for (const format::Surfel& surfel : surfels) {
        radius = std::max(radius, glm::distance(vector_of(surfel.position), glm::dvec3(bounds.centre)));
        cosine = std::min(cosine, glm::dot(normal_of(surfel), glm::dvec3(bounds.axis)));
    }
    bounds.radius = std::nextafter(static_cast<float>(radius), std::numeric_limits<float>::infinity());
    bounds.spread_cosine = static_cast<float>(std::max(cosine, -1.0));
    bounds.spread_sine = static_cast<float>(std::sqrt(std::max(1 - cosine * cosine, 0.0)));
    return bounds;
}

// Cosine and sine.
struct Angle {
    double cosine, sine;
};
Angle operator+(const Angle& a, const Angle& b) {
    return {a.cosine * b.cosine - a.sine * b.sine, a.sine * b.cosine + a.cosine * b.sine};
}
Angle operator-(const Angle& a, const Angle& b) {
    return a + Angle{b.cosine, -b.sine};
}

}  // namespace

std::vector<SurfelBounds> bound_surfels(const ModelView& model, std::span<const format::Surfel> more) {
    const std::uint64_t own = model.surfel_count(), all = own + more.size();
    std::vector<SurfelBounds> bounds((all + kBoundedSurfels - 1) / kBoundedSurfels);
    tbb::parallel_for(std::size_t{0}, bounds.size(), [&](std::size_t i) {
        std::array<format::Surfel, kBoundedSurfels> surfels;
        const std::uint64_t first = i * kBoundedSurfels, count = std::min<std::uint64_t>(all - first, kBoundedSurfels);
        for (std::uint64_t n = 0; n < count; ++n)
            surfels[n] = first + n < own ? model.surfel(first + n) : more[first + n - own];
        bounds[i] = bound(std::span(surfels).first(count));
    });
    return bounds;
}

SurfelSight::SurfelSight(const Camera& camera, std::uint32_t width, std::uint32_t height,
                         const glm::dmat4& model_to_view, double scale, bool two_sided, double horizon)
    : model_to_view_(model_to_view),
      scale_(std::abs(scale)),
      translation_(glm::length(glm::dvec3(model_to_view[3]))),
      two_sided_(two_sided),
      orthographic_(camera.orthographic),
      near_plane_(camera.near_plane),
      least_cosine_(std::cos(std::acos(horizon) - kSlack)),
      least_sine_(std::sin(std::acos(horizon) - kSlack)),
      most_cosine_(std::cos(std::acos(horizon) + kSlack)),
      most_sine_(std::sin(std::acos(horizon) + kSlack)),
      half_((0.5 * glm::dvec2(width, height) + kSetupReach) / pixel_scale(camera, height)),
      to_side_(orthographic_ ? glm::dvec2(1) : 1.0 / glm::sqrt(1.0 + half_ * half_)) {}

Sight SurfelSight::of(const SurfelBounds& bounds) const {
    const glm::dvec3 in_model(bounds.centre);
    const glm::dvec3 centre(model_to_view_ * glm::dvec4(in_model, 1));
    const double own_radius = scale_ * static_cast<double>(bounds.radius);
    const double radius = own_radius + kRounding * (scale_ * glm::length(in_model) + own_radius + translation_);
    const Sight framed = in_frustum(centre, radius, kSolidReach * scale_ * static_cast<double>(bounds.largest));
    if (two_sided_ || framed == Sight::kNone) return framed;
    const Sight faced = facing(centre, radius, bounds);
    if (faced == Sight::kNone || framed == Sight::kAll) return faced;
    return Sight::kSome;
}

// may_show of splat_setup.comp is about distances from planes, which change by no more than a point moves.
Sight SurfelSight::in_frustum(const glm::dvec3& centre, double radius, double reach) const {
    const double depth = -centre.z;
    const glm::dvec2 outside = (glm::abs(glm::dvec2(centre)) - half_ * (orthographic_ ? 1.0 : depth)) * to_side_;
    const double farthest = std::max(outside.x, outside.y), rounded = reach * (1 + kRounding);
    if (farthest > radius + rounded || depth + radius + rounded < near_plane_ * (1 - kRounding)) return Sight::kNone;
    return farthest + radius <= 0 && depth - radius >= near_plane_ * (1 + kRounding) ? Sight::kAll : Sight::kSome;
}

// A disk faces away where its normal is within the horizon's angle of the direction from the eye to its centre: all of
// them where beta + spread + alpha is, none where beta - spread - alpha is not; beta between the cone's axis and the
// ball's centre, alpha what the ball takes.
Sight SurfelSight::facing(const glm::dvec3& centre, double radius, const SurfelBounds& bounds) const {
    const Angle least{least_cosine_, least_sine_}, most{most_cosine_, most_sine_};
    glm::dvec3 away(0, 0, -1);
    Angle alpha{1, 0};
    if (!orthographic_) {
        const double distance = glm::length(centre);
        if (!(distance > radius)) return Sight::kSome;
        away = centre / distance;
        alpha.sine = radius / distance;
        alpha.cosine = std::sqrt(1 - alpha.sine * alpha.sine);
    }
    const double beta_cosine = glm::dot(glm::normalize(glm::dmat3(model_to_view_) * glm::dvec3(bounds.axis)), away);
    const Angle spread{static_cast<double>(bounds.spread_cosine), static_cast<double>(bounds.spread_sine)};
    // Sines tell whether an angle is still between 0 and 180 degrees: alpha and what is added to are below 90 and 180.
    const Angle left_of_spread = least - spread, left = left_of_spread - alpha;
    if (left_of_spread.sine > 0 && left.sine > 0 && beta_cosine > left.cosine) return Sight::kNone;
    const Angle with_spread = most + spread, with_all = with_spread + alpha;
    if (with_spread.sine > 0 && with_all.sine > 0 && beta_cosine < with_all.cosine) return Sight::kAll;
    return Sight::kSome;
}

}  // namespace splice
