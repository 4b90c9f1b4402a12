#include "engine/scene/ellipse_record.h"

#include "preprocess/model_format/half.h"
#include "preprocess/model_format/octahedral.h"
#include "preprocess/model_format/tangent_frame.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace splice {

namespace {

constexpr std::uint16_t kSign = 0x8000, kLargestHalf = 0x7bff;

double dot(const std::array<float, 3>& a, const std::array<float, 3>& b) {
    double sum = 0;
    for (std::size_t k = 0; k < 3; ++k)
        sum += static_cast<double>(a[k]) * static_cast<double>(b[k]);
    return sum;
}

}  // namespace

format::Surfel ellipse_record(const format::PointNode& node, std::uint16_t patch) {
    format::Surfel record{};
    std::copy(std::begin(node.position), std::end(node.position), std::begin(record.position));
    std::copy(std::begin(node.colour), std::end(node.colour), std::begin(record.colour));
    record.extent = node.extent;
    record.normal = node.normal;
    record.patch = patch;

    const TangentFrame frame = tangents_of(decode_octahedral(node.normal));
    const std::array<float, 3> axis = decode_octahedral(node.major_axis);
    constexpr double kStep = std::numbers::pi / kAxisDirections;
    const auto direction = std::lround(std::atan2(dot(axis, frame.t), dot(axis, frame.s)) / kStep);
    const double major = static_cast<double>(node.major);
    const double ratio = major > 0 ? static_cast<double>(node.minor) / major : 1;
    // Turned by half a step, no point moves by more than that times the major axis: a share of the minor one by which
    // both grow.
    const double growth = 1 + 0.5 * kStep / std::max(ratio, 1.0 / kAxisSteps);
    const auto steps = static_cast<unsigned>(std::clamp(std::ceil(ratio * kAxisSteps), 1.0, double{kAxisSteps}));
    const float length = static_cast<float>(std::min(major * growth, 65504.0));
    record.radius = static_cast<std::uint16_t>(std::min(half_at_least(length), kLargestHalf) | kSign);
    record.clip = static_cast<std::uint16_t>(steps << 8 | (static_cast<unsigned>(direction) & (kAxisDirections - 1)));
    return record;
}

bool is_ellipse_record(const format::Surfel& record) {
    return (record.radius & kSign) != 0;
}

EllipseAxes ellipse_axes(const format::Surfel& record) {
    const double major = -static_cast<double>(float_from_half(record.radius));
    return {major, major * (record.clip >> 8) / kAxisSteps, (record.clip & 0xff) * std::numbers::pi / kAxisDirections};
}

}  // namespace splice
