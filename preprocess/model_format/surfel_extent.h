// Surfel::extent: three lengths along the disk's normal as shares of its radius, each stored as a step of a geometric
// series, 0 as step 0, so that it reaches no less far than what it stands for. Rounding up goes too far by less than
// one step: 32 % for the surface, 19 % for epsilon. shaders/glsl/include/surfel_vertex.glsl decodes the same.
//   bits 0..4    above: the surface that the disk stands for stays this near to its plane on the normal's side
//   bits 5..9    below: the same on the other side; shares from 2^-12 to 1
//   bits 10..15  epsilon: depth offset before the user's scale, the sampling's spacing; shares from 2^-5.75 to 2^9.75
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

namespace splice {

inline constexpr float kSwellStep = 0.4f, kEpsilonStep = 0.25f;  // powers of two
inline constexpr float kSwellOne = 31, kEpsilonOne = 24;         // the steps that stand for the radius itself
inline constexpr float kSwellLast = 31, kEpsilonLast = 63;

/// Lengths in one unit, `radius` above 0. What the last step does not reach is clamped.
struct SurfelExtent {
    float above = 0, below = 0, epsilon = 0;
};

inline std::uint16_t encode_extent(const SurfelExtent& extent, float radius) {
    const auto step = [&](float length, float powers, float one, float last) -> unsigned {
        if (!(length > 0) || !(radius > 0)) return 0u;
        return static_cast<unsigned>(std::clamp(one + std::ceil(std::log2(length / radius) / powers), 1.0f, last));
    };
    return static_cast<std::uint16_t>(step(extent.above, kSwellStep, kSwellOne, kSwellLast) |
                                      step(extent.below, kSwellStep, kSwellOne, kSwellLast) << 5 |
                                      step(extent.epsilon, kEpsilonStep, kEpsilonOne, kEpsilonLast) << 10);
}

/// What each step stands for, in radii.
template <std::size_t kSteps>
inline std::array<float, kSteps> extent_table(float powers, float one) {
    std::array<float, kSteps> table{};
    for (std::size_t step = 1; step < kSteps; ++step)
        table[step] = std::exp2(powers * (static_cast<float>(step) - one));
    return table;
}

inline SurfelExtent decode_extent(std::uint16_t bits, float radius) {
    static const auto swell = extent_table<32>(kSwellStep, kSwellOne);
    static const auto epsilon = extent_table<64>(kEpsilonStep, kEpsilonOne);
    return {radius * swell[bits & 31u], radius * swell[bits >> 5 & 31u], radius * epsilon[bits >> 10]};
}

}  // namespace splice
