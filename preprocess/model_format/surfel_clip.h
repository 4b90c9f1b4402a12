// Surfel::clip: the straight line at which a disk is cut, so that it does not overhang the crease or border that it lies
// at (clip lines: Zwicker et al. 2004). Kept is the side of the centre, where x u + y v <= offset, (u, v) in radii along
// s, t = tangents_of(normal). shaders/glsl/include/surfel_frame.glsl decodes the same.
//   bits 0..5   direction (x, y), in 64ths of a turn from u to v
//   bits 6..15  1 - offset in 1023rds, what is cut from the rim; 0: the disk is whole
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>

namespace splice {

inline constexpr int kClipDirections = 64;
inline constexpr float kClipSteps = 1023;

struct SurfelClip {
    float x = 0, y = 0, offset = 1;  // x = y = 0: the disk is whole
};

inline constexpr std::uint16_t kNoClip = 0;

/// `offset` from 0, rounded up.
inline std::uint16_t encode_clip(int direction, float offset) {
    const auto cut = static_cast<unsigned>(std::floor(std::clamp(1 - offset, 0.0f, 1.0f) * kClipSteps));
    return cut == 0 ? kNoClip : static_cast<std::uint16_t>(cut << 6 | static_cast<unsigned>(direction));
}

inline SurfelClip decode_clip(std::uint16_t bits) {
    if (bits >> 6 == 0) return {};
    const float turn = 2 * std::numbers::pi_v<float> * static_cast<float>(bits & 63) / kClipDirections;
    return {std::cos(turn), std::sin(turn), 1 - static_cast<float>(bits >> 6) / kClipSteps};
}

}  // namespace splice
