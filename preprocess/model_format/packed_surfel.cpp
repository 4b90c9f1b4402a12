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

// Surfel::extent's bits of epsilon, by those of above and below.
std::array<std::uint16_t, 1024> epsilon_table() {
    const auto swell = extent_table<32>(kSwellStep, kSwellOne);
    std::array<std::uint16_t, 1024> table{};
    for (std::size_t i = 0; i < table.size(); ++i)
        table[i] = encode_extent({0, 0, kPackedEpsilon + swell[i & 31] + swell[i >> 5]}, 1);
    return table;
}

}  // namespace

std::array<std::uint32_t, 2> pack_place(const float (&position)[3]) {
    std::array<std::uint64_t, 3> steps;
    for (std::size_t axis = 0; axis < 3; ++axis)
        steps[axis] = static_cast<std::uint64_t>(
            std::clamp((static_cast<double>(position[axis]) + 0.5) * kPlaceSteps + 0.5, 0.0, double{kPlaceSteps - 1}));
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
template <unsigned bits>
std::uint32_t shorten_normal(std::uint32_t octahedral) {
    constexpr int largest = (1 << (bits - 1)) - 1;
    const auto share = [](std::uint32_t half) {
        return std::max(static_cast<double>(static_cast<std::int16_t>(half & 0xffffu)) / 32767, -1.0);
    };
    const double u = share(octahedral) * largest, v = share(octahedral >> 16) * largest;
    const auto code = [&](int a, int b) {
        constexpr std::uint32_t mask = (1u << bits) - 1;
        return (static_cast<std::uint32_t>(a) & mask) | (static_cast<std::uint32_t>(b) & mask) << bits;
    };
    const auto rounded = [](double value) { return static_cast<int>(value + (value < 0 ? -0.5 : 0.5)); };
    const std::uint32_t exact = code(rounded(u), rounded(v));
    if (lengthen_normal<bits>(exact) == octahedral) return exact;
    // Of any length, which the comparison takes out again.
    const auto direction = [&](double a, double b) {
        const double up = largest - std::abs(a) - std::abs(b), below = std::max(-up, 0.0);
        return std::array<double, 3>{a - std::copysign(below, a), b - std::copysign(below, b), up};
    };
    const std::array<double, 3> normal = direction(u, v);
    std::uint32_t nearest = 0;
    // Squares of cosines are compared as fractions.
    double most = -1, most_square = 1;
    const int low_u = static_cast<int>(std::floor(u)), low_v = static_cast<int>(std::floor(v));
    for (const int a : {low_u, std::min(low_u + 1, largest)})
        for (const int b : {low_v, std::min(low_v + 1, largest)}) {
            const std::array<double, 3> d = direction(a, b);
            const double dot = d[0] * normal[0] + d[1] * normal[1] + d[2] * normal[2];
            const double square = d[0] * d[0] + d[1] * d[1] + d[2] * d[2];
            if (dot * dot * most_square > most * square) {
                most = dot * dot;
                most_square = square;
                nearest = code(a, b);
            }
        }
    return nearest;
}

template <unsigned bits>
std::uint32_t lengthen_normal(std::uint32_t shortened) {
    constexpr int largest = (1 << (bits - 1)) - 1;
    const auto lengthen = [&](std::uint32_t half) {
        int value = static_cast<int>(half & ((1u << bits) - 1));
        if (value > largest) value -= 1 << bits;
        // value * 32767 / largest, to the nearest.
        const int doubled = 2 * 32767 * std::max(value, -largest);
        return static_cast<std::uint32_t>((doubled + (doubled < 0 ? -largest : largest)) / (2 * largest)) & 0xffffu;
    };
    return lengthen(shortened) | lengthen(shortened >> bits) << 16;
}

template std::uint32_t shorten_normal<10>(std::uint32_t);
template std::uint32_t shorten_normal<12>(std::uint32_t);
template std::uint32_t lengthen_normal<10>(std::uint32_t);
template std::uint32_t lengthen_normal<12>(std::uint32_t);

format::PackedSurfel pack_surfel(const format::Surfel& surfel) {
    format::PackedSurfel packed{};
    const auto place = pack_place(surfel.position);
    std::ranges::copy(place, packed.place);
    const std::uint32_t radius = std::min(std::uint32_t{surfel.radius}, kLargestRadius);
    const std::uint32_t above = surfel.extent & 31u, below = surfel.extent >> 5 & 31u;
    packed.place[1] |= (above & 15u) << 28;
    packed.look = std::uint32_t{surfel.colour[0]} | std::uint32_t{surfel.colour[1]} << 8 |
                  std::uint32_t{surfel.colour[2]} << 16 | (below & 15u) << 24 | (radius & 15u) << 28;
    packed.shape = shorten_normal<kNormalBits>(surfel.normal) | radius >> 4 << 20 | above >> 4 << 30 | below >> 4 << 31;
    return packed;
}

format::Surfel unpack_surfel(const format::PackedSurfel& packed, std::uint16_t patch) {
    static const auto epsilons = epsilon_table();
    format::Surfel surfel{};
    unpack_place(packed.place, surfel.position);
    surfel.radius = static_cast<std::uint16_t>(packed.look >> 28 | (packed.shape >> 20 & 0x3ffu) << 4);
    const std::uint32_t above = packed.place[1] >> 28 | (packed.shape >> 30 & 1u) << 4,
                        below = (packed.look >> 24 & 15u) | packed.shape >> 31 << 4;
    surfel.extent = static_cast<std::uint16_t>(above | below << 5 | epsilons[below << 5 | above]);
    surfel.normal = lengthen_normal<kNormalBits>(packed.shape);
    for (unsigned channel = 0; channel < 3; ++channel)
        surfel.colour[channel] = static_cast<std::uint8_t>(packed.look >> 8 * channel);
    surfel.patch = patch;
    return surfel;
}

}  // namespace splice
