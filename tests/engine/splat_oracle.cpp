#include "tests/engine/splat_oracle.h"

#include "preprocess/model_format/half.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace splice::test {

namespace {

// Any two unit vectors across n.
std::pair<glm::dvec3, glm::dvec3> across(const glm::dvec3& n) {
    const glm::dvec3 helper = std::abs(n.x) < 0.7 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
    const glm::dvec3 s = glm::normalize(glm::cross(n, helper));
    return {s, glm::cross(n, s)};
}

constexpr double kPrefilter = 0.3;  // variance, pixels^2; splat.glsl
constexpr double kSpeck = 0.25;     // pixels; splat.glsl

}  // namespace

SplatOracle::SplatOracle(const Disk& disk, const Camera& camera, std::uint32_t width, std::uint32_t height,
                         bool prefilter)
    : camera_(camera),
      width_(width),
      height_(height),
      scale_(pixel_scale(camera, height)),
      prefilter_(prefilter),
      radius_(float_from_half(half_at_least(disk.radius))) {
    const glm::dmat4 view = view_matrix(camera);
    centre_ = glm::dvec3(view * glm::dvec4(glm::dvec3(disk.centre), 1));
    normal_ = glm::normalize(glm::dmat3(view) * glm::dvec3(disk.normal));
    const auto [s, t] = across(normal_);
    const double rise = radius_ * std::hypot(s.z, t.z);
    crosses_near_ = -centre_.z - rise < camera.near_plane;
    if (crosses_near_) return;

    centre_px_ = window(centre_);
    glm::dvec2 low = centre_px_, high = centre_px_;
    for (int degrees = 0; degrees < 360; ++degrees) {
        const double angle = glm::radians(static_cast<double>(degrees));
        const glm::dvec2 rim = window(centre_ + radius_ * (std::cos(angle) * s + std::sin(angle) * t));
        low = glm::min(low, rim);
        high = glm::max(high, rim);
    }
    sub_pixel_ = high.x - low.x < kSpeck && high.y - low.y < kSpeck;
    // Central differences of the projection along the tangents.
    const double h = 1e-6 * -centre_.z;
    const glm::dvec2 along_s = (window(centre_ + h * s) - window(centre_ - h * s)) / (2 * h);
    const glm::dvec2 along_t = (window(centre_ + h * t) - window(centre_ - h * t)) / (2 * h);
    const glm::dmat2 jacobian(along_s, along_t);
    const glm::dmat2 reconstruction = jacobian * glm::transpose(jacobian) * (radius_ * radius_ / 2);
    const glm::dmat2 resampling = reconstruction + glm::dmat2(kPrefilter);
    covariance_inverse_ = glm::inverse(resampling);
    peak_ = std::sqrt(std::max(glm::determinant(reconstruction), 0.0) / glm::determinant(resampling));
}

glm::dvec2 SplatOracle::window(const glm::dvec3& p) const {
    const double scale = camera_.orthographic ? scale_ : scale_ / -p.z;
    return {width_ / 2 + scale * p.x, height_ / 2 - scale * p.y};
}

std::optional<SplatOracle::Meeting> SplatOracle::meet(const glm::dvec2& pixel) const {
    const glm::dvec2 offset((pixel.x - width_ / 2) / scale_, -(pixel.y - height_ / 2) / scale_);
    const glm::dvec3 origin = camera_.orthographic ? glm::dvec3(offset, 0) : glm::dvec3(0);
    const glm::dvec3 ray = camera_.orthographic ? glm::dvec3(0, 0, -1) : glm::dvec3(offset, -1);
    const double facing = glm::dot(ray, normal_);
    if (facing == 0) return std::nullopt;
    const double t = glm::dot(centre_ - origin, normal_) / facing;
    const glm::dvec3 across_disk = origin + t * ray - centre_;
    return Meeting{t, glm::dot(across_disk, across_disk) / (radius_ * radius_)};
}

SplatPixel SplatOracle::at(std::uint32_t x, std::uint32_t y) const {
    const glm::dvec2 pixel(x + 0.5, y + 0.5);
    SplatPixel result;
    result.certainty = std::numeric_limits<double>::infinity();
    double exponent = std::numeric_limits<double>::infinity();
    if (const auto meeting = meet(pixel)) {
        result.on_disk = meeting->distance2 <= 1 && meeting->depth >= camera_.near_plane;
        result.depth = meeting->depth;
        result.certainty =
            std::min(std::abs(std::sqrt(meeting->distance2) - 1), std::abs(meeting->depth / camera_.near_plane - 1));
        if (result.on_disk) exponent = meeting->distance2;
    }
    if (crosses_near_) {
        result.weight = result.on_disk ? std::exp(-exponent) : 0;
        return result;
    }
    if (sub_pixel_ && glm::floor(pixel) == glm::floor(centre_px_)) {
        const glm::dvec2 from_edge = glm::abs(centre_px_ - glm::round(centre_px_));
        result.certainty = std::min({result.certainty, from_edge.x, from_edge.y});
        result.between = !result.on_disk;
        if (result.between) result.depth = -centre_.z;
    }
    if (prefilter_) {
        const glm::dvec2 d = pixel - centre_px_;
        const double ewa = glm::dot(d, covariance_inverse_ * d) / 2;
        result.certainty = std::min(result.certainty, std::abs(ewa - 1));
        exponent = std::min(exponent, ewa);
    }
    const bool shown = result.on_disk || result.between || exponent < 1;
    result.weight = shown ? (prefilter_ ? std::max(peak_, 1.0 / 4096) : 1) * std::exp(-std::min(exponent, 1.0)) : 0;
    return result;
}

}  // namespace splice::test
