// sRGB-encoded 8-bit colours and linear light (IEC 61966-2-1).
#pragma once

#include <array>
#include <cstdint>

namespace splice {

/// Linear light in 0..1 of an sRGB-encoded byte.
float linear_from_srgb(std::uint8_t encoded);

/// `linear` is clamped to 0..1 and rounded to the nearest byte.
std::uint8_t srgb_from_linear(float linear);

/// RGBA8 as linear light; alpha, which is not encoded, as a share of 255.
std::array<float, 4> linear_from_rgba8(std::uint32_t colour);
std::uint32_t rgba8_from_linear(const std::array<float, 4>& linear);

/// The product in linear light: a material's diffuse colour times a vertex colour.
std::uint32_t multiply_colours(std::uint32_t a, std::uint32_t b);

}  // namespace splice
