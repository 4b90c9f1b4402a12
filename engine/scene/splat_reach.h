// What shaders draw beyond a surfel's disk and its horizon: whatever decides that something cannot be seen allows for
// it.
#pragma once

#include <numbers>

namespace splice {

/// Cosine between a surfel's normal and the direction to the eye below which it is not drawn (one-sided) or turned to
/// the eye (two-sided); HORIZON of frame.glsl.
inline constexpr double kHorizon = -0.25;

/// Pixels by which a splat may exceed its disk: sqrt(0.6) of the prefilter, up to 1 of a speck's pixel, and rounding.
inline constexpr double kPrefilterReach = 1.5;

/// Pixels beyond the picture at which setup keeps splats, which is on the safe side; PREFILTER_REACH of splat.glsl.
inline constexpr double kSetupReach = 2;

/// Radii from a disk's centre to the rim of its solid's faces, at most: the surface leaves the plane by at most a
/// radius (surfel_extent.h).
inline constexpr double kSolidReach = std::numbers::sqrt2;

}  // namespace splice
