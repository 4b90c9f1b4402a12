#include "preprocess/model_format/srgb.h"

#include <algorithm>
#include <cmath>

namespace splice {
namespace {

std::array<float, 256> decoding_table() {
    std::array<float, 256> table{};
    for (std::size_t i = 0; i < table.size(); ++i) {
        const double encoded = static_cast<double>(i) / 255;
        table[i] = static_cast<float>(encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4));
    }
    return table;
}

}  // namespace

float linear_from_srgb(std::uint8_t encoded) {
    static const std::array<float, 256> table = decoding_table();
    return table[encoded];
}

std::uint8_t srgb_from_linear(float linear) {
    const float clamped = std::clamp(linear, 0.0f, 1.0f);
    const float encoded = clamped <= 0.0031308f ? 12.92f * clamped : 1.055f * std::pow(clamped, 1 / 2.4f) - 0.055f;
    return static_cast<std::uint8_t>(std::lround(255 * encoded));
}

std::array<float, 4> linear_from_rgba8(std::uint32_t colour) {
    const auto channel = [&](unsigned shift) { return static_cast<std::uint8_t>(colour >> shift); };
    return {linear_from_srgb(channel(0)), linear_from_srgb(channel(8)), linear_from_srgb(channel(16)),
            static_cast<float>(channel(24)) / 255};
}

std::uint32_t rgba8_from_linear(const std::array<float, 4>& linear) {
    const auto alpha = static_cast<std::uint32_t>(std::lround(255 * std::clamp(linear[3], 0.0f, 1.0f)));
    return std::uint32_t{srgb_from_linear(linear[0])} | std::uint32_t{srgb_from_linear(linear[1])} << 8 |
           std::uint32_t{srgb_from_linear(linear[2])} << 16 | alpha << 24;
}

std::uint32_t multiply_colours(std::uint32_t a, std::uint32_t b) {
    constexpr std::uint32_t white = 0xffffffffu;
    if (a == white) return b;
    if (b == white) return a;
    std::array<float, 4> product = linear_from_rgba8(a);
    const std::array<float, 4> factor = linear_from_rgba8(b);
    for (std::size_t i = 0; i < 4; ++i)
        product[i] *= factor[i];
    return rgba8_from_linear(product);
}

}  // namespace splice
