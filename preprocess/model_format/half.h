// IEEE 754 half precision, as VK_FORMAT_R16G16_SFLOAT reads it: 11 significant bits, least step 6e-8, largest 65504.
#pragma once

#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

namespace splice {

inline float float_from_half(std::uint16_t half) {
    const int exponent = (half >> 10) & 0x1f;
    const std::uint32_t sign = (half & 0x8000u) << 16, fraction = half & 0x3ffu;
    if (exponent == 0x1f && fraction != 0) return std::numeric_limits<float>::quiet_NaN();
    // Subnormal: steps of 2^-24.
    if (exponent == 0) return (sign != 0 ? -0x1p-24f : 0x1p-24f) * static_cast<float>(fraction);
    const std::uint32_t biased = exponent == 0x1f ? 0xffu : static_cast<std::uint32_t>(exponent - 15 + 127);
    return std::bit_cast<float>(sign | biased << 23 | fraction << 13);
}

/// The least half that is not below `value`: lengths that must still reach what they reach. `value` is a length, at
/// least 0 and at most 65504; the result exceeds it by less than 0.1 % (or by less than 6e-8, whichever is more).
inline std::uint16_t half_at_least(float value) {
    // Above the sign, halves are ordered as their bits are; truncation errs below by less than one step.
    const std::uint32_t bits = std::bit_cast<std::uint32_t>(value);
    const int exponent = static_cast<int>(bits >> 23) - 127 + 15;
    const std::uint32_t truncated = exponent > 0 ? static_cast<std::uint32_t>(exponent) << 10 | ((bits >> 13) & 0x3ffu)
                                                 : static_cast<std::uint32_t>(std::ldexp(value, 24));
    const auto half = static_cast<std::uint16_t>(truncated);
    return float_from_half(half) < value ? static_cast<std::uint16_t>(half + 1) : half;
}

}  // namespace splice
