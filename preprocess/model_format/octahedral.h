// Unit vectors in 32 bits: the octahedral map (Meyer et al. 2010, "On floating-point normal vectors"), two 16-bit
// snorm. Angular error below 0.004 degrees. shaders/glsl/include/octahedral.glsl decodes the same bits.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

namespace splice {

/// `n` need not be unit, but must not be zero.
inline std::uint32_t encode_octahedral(float x, float y, float z) {
    const float l1 = std::abs(x) + std::abs(y) + std::abs(z);
    float u = x / l1, v = y / l1;
    if (z < 0) {
        const float folded_u = (1 - std::abs(v)) * (u >= 0 ? 1.0f : -1.0f);
        v = (1 - std::abs(u)) * (v >= 0 ? 1.0f : -1.0f);
        u = folded_u;
    }
    const auto snorm = [](float f) {
        // To the nearest, exactly, without std::lround's call.
        const auto steps = static_cast<double>(std::clamp(f, -1.0f, 1.0f) * 32767.0f);
        return static_cast<std::uint16_t>(static_cast<std::int16_t>(steps + (steps < 0 ? -0.5 : 0.5)));
    };
    return static_cast<std::uint32_t>(snorm(u)) | (static_cast<std::uint32_t>(snorm(v)) << 16);
}

inline std::array<float, 3> decode_octahedral(std::uint32_t bits) {
    const auto unpack = [](std::uint32_t half) {
        return std::max(static_cast<float>(static_cast<std::int16_t>(half & 0xffffu)) / 32767.0f, -1.0f);
    };
    float x = unpack(bits), y = unpack(bits >> 16);
    const float z = 1 - std::abs(x) - std::abs(y);
    if (z < 0) {
        const float folded_x = (1 - std::abs(y)) * (x >= 0 ? 1.0f : -1.0f);
        y = (1 - std::abs(x)) * (y >= 0 ? 1.0f : -1.0f);
        x = folded_x;
    }
    const float inverse_length = 1 / std::sqrt(x * x + y * y + z * z);
    return {x * inverse_length, y * inverse_length, z * inverse_length};
}

}  // namespace splice
