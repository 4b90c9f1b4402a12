#include "preprocess/model_format/packed_surfel.h"

#include "preprocess/model_format/half.h"
#include "preprocess/model_format/octahedral.h"
#include "preprocess/model_format/surfel_extent.h"

#include <algorithm>

namespace splice {
namespace {

constexpr std::uint32_t kPlaceBits = 20, kPlaceMask = kPlaceSteps - 1;
constexpr unsigned kNormalBits = 10;
constexpr std::uint32_t kLargestRadius = 0x3fff;  // the half below 2

}  // namespace

std::array<std::uint32_t, 2> pack_place(const float (&position)[3]) {
    std::array<std::uint64_t, 3> steps;
    for (std::size_t axis = 0; axis < 3; ++axis)
        steps[axis] = static_cast<std::uint64_t>(std::clamp(
            std::round((static_cast<double>(position[axis]) + 0.5) * kPlaceSteps), 0.0, double{kPlaceSteps - 1}));
    const std::uint64_t bits = steps[0] | steps[1] << kPlaceBits | steps[2] << 2 * kPlaceBits;
    return {static_cast<std::uint32_t>(bits), static_cast<std::uint32_t>(bits >> 32)};
}

void unpack_place(const std::uint32_t (&place)[2], float (&position)[3]) {
    const std::uint64_t bits = std::uint64_t{place[1]} << 32 | place[0];
    for (unsigned axis = 0; axis < 3; ++axis)
        position[axis] =
            static_cast<float>(bits >> axis * kPlaceBits & kPlaceMask) / static_cast<float>(kPlaceSteps) - 0.5f;
}

// Rounding u and v does not find the nearest: of the four around, one does (Cigolle et al. 2014, "A Survey of Efficient
// Representations for Independent Unit Vectors").
std::uint32_t shorten_normal(std::uint32_t octahedral, unsigned bits) {
    const auto largest = static_cast<float>((1u << (bits - 1)) - 1);
    const auto floor_of = [&](std::uint32_t half) {
        return std::floor(std::max(static_cast<float>(static_cast<std::int16_t>(half & 0xffffu)) / 32767.0f, -1.0f) *
                          largest);
    };
    const float u = floor_of(octahedral), v = floor_of(octahedral >> 16);
    const auto normal = decode_octahedral(octahedral);
    std::uint32_t nearest = 0;
    float least = 8;
    for (const float up_u : {0.0f, 1.0f})
        for (const float up_v : {0.0f, 1.0f}) {
            const auto code = [&](float value) {
                return static_cast<std::uint32_t>(static_cast<int>(std::min(value, largest))) & ((1u << bits) - 1);
            };
            const std::uint32_t candidate = code(u + up_u) | code(v + up_v) << bits;
            const auto there = decode_octahedral(lengthen_normal(candidate, bits));
            float squared = 0;
            for (std::size_t k = 0; k < 3; ++k)
                squared += (there[k] - normal[k]) * (there[k] - normal[k]);
            if (squared < least) {
                least = squared;
                nearest = candidate;
            }
        }
    return nearest;
}

std::uint32_t lengthen_normal(std::uint32_t shortened, unsigned bits) {
    const int largest = (1 << (bits - 1)) - 1;
    const auto lengthen = [&](std::uint32_t half) {
        int value = static_cast<int>(half & ((1u << bits) - 1));
        if (value > largest) value -= 1 << bits;
        const float share = static_cast<float>(std::max(value, -largest)) / static_cast<float>(largest);
        return static_cast<std::uint32_t>(std::lround(share * 32767.0f)) & 0xffffu;
    };
    return lengthen(shortened) | lengthen(shortened >> bits) << 16;
}

format::PackedSurfel pack_surfel(const format::Surfel& surfel) {
    format::PackedSurfel packed{};
    const auto place = pack_place(surfel.position);
    std::ranges::copy(place, packed.place);
    const std::uint32_t radius = std::min(std::uint32_t{surfel.radius}, kLargestRadius);
    const std::uint32_t above = surfel.extent & 31u, below = surfel.extent >> 5 & 31u;
    packed.place[1] |= (above & 15u) << 28;
    packed.look = std::uint32_t{surfel.colour[0]} | std::uint32_t{surfel.colour[1]} << 8 |
                  std::uint32_t{surfel.colour[2]} << 16 | (below & 15u) << 24 | (radius & 15u) << 28;
    packed.shape = shorten_normal(surfel.normal, kNormalBits) | radius >> 4 << 20 | above >> 4 << 30 | below >> 4 << 31;
    return packed;
}

format::Surfel unpack_surfel(const format::PackedSurfel& packed, std::uint16_t patch) {
    static const auto swell = extent_table<32>(kSwellStep, kSwellOne);
    format::Surfel surfel{};
    unpack_place(packed.place, surfel.position);
    surfel.radius = static_cast<std::uint16_t>(packed.look >> 28 | (packed.shape >> 20 & 0x3ffu) << 4);
    const std::uint32_t above = packed.place[1] >> 28 | (packed.shape >> 30 & 1u) << 4,
                        below = (packed.look >> 24 & 15u) | packed.shape >> 31 << 4;
    const std::uint16_t epsilon = encode_extent({0, 0, kPackedEpsilon + swell[above] + swell[below]}, 1);
    surfel.extent = static_cast<std::uint16_t>(above | below << 5 | epsilon);
    surfel.normal = lengthen_normal(packed.shape, kNormalBits);
    for (unsigned channel = 0; channel < 3; ++channel)
        surfel.colour[channel] = static_cast<std::uint8_t>(packed.look >> 8 * channel);
    surfel.patch = patch;
    return surfel;
}

}  // namespace splice
