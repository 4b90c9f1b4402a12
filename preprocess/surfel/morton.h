// Morton (Z-order) codes: nearby points get nearby codes.
#pragma once

#include "preprocess/mesh/indexed_mesh.h"

#include <algorithm>
#include <cstdint>

namespace splice {

/// Spreads the low 10 bits of `v` to every third bit.
inline std::uint32_t spread_bits(std::uint32_t v) {
    v = (v | (v << 16)) & 0x030000ffu;
    v = (v | (v << 8)) & 0x0300f00fu;
    v = (v | (v << 4)) & 0x030c30c3u;
    return (v | (v << 2)) & 0x09249249u;
}

/// 30-bit code of a point in the cube of side `extent` at `low`, x in the lowest bit; points outside are clamped.
inline std::uint32_t morton_code(const Vec3f& point, const Vec3f& low, float extent) {
    const Vec3f scaled = (point - low) * (extent > 0 ? 1023.0f / extent : 0.0f);
    const auto bits = [&](int axis) {
        return spread_bits(static_cast<std::uint32_t>(std::clamp(scaled[axis], 0.0f, 1023.0f)));
    };
    return bits(0) | (bits(1) << 1) | (bits(2) << 2);
}

}  // namespace splice
