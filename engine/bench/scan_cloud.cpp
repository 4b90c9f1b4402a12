#include "engine/bench/scan_cloud.h"

#include "preprocess/model_format/error.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <fstream>
#include <string>
#include <vector>

namespace splice::bench {
namespace {

constexpr std::size_t kHeader = 227, kRecord = 26;  // bytes (LAS Specification 1.2, tables 3 and 10)
constexpr double kUnit = 0.001;                     // metres
constexpr double kSpacing = 0.5;                    // metres
constexpr double kEasting = 636000, kNorthing = 849000;

// Uniform in 0..1, from the bits of a counter (splitmix64).
double random_share(std::uint64_t counter) {
    std::uint64_t x = (counter + 1) * 0x9e3779b97f4a7c15u;
    x = (x ^ x >> 30) * 0xbf58476d1ce4e5b9u;
    x = (x ^ x >> 27) * 0x94d049bb133111ebu;
    return static_cast<double>((x ^ x >> 31) >> 11) * 0x1p-53;
}

struct Ground {
    double height;
    std::uint8_t colour[3];
};

Ground ground_at(double x, double y, double chance) {
    double height = 12 * std::sin(x / 90) * std::cos(y / 120) + 3 * std::sin((x + y) / 23);
    const auto lot =
        static_cast<std::uint64_t>(std::floor(x / 25)) << 32 | static_cast<std::uint64_t>(std::floor(y / 25));
    const double use = random_share(lot),
                 inside = std::max(std::abs(std::remainder(x - 12.5, 25)), std::abs(std::remainder(y - 12.5, 25)));
    if (use < 0.2 && inside < 8) return {std::floor(height / 3) * 3 + 9, {170, 90, 70}};
    if (use > 0.7 && inside < 10) return {height + 10 * chance, {50, static_cast<std::uint8_t>(90 + 60 * chance), 40}};
    height += 0.03 * chance;
    return {height, {120, static_cast<std::uint8_t>(130 + 20 * std::sin(x / 40)), 90}};
}

template <class T>
void put(std::vector<char>& bytes, std::size_t at, T value) {
    std::memcpy(bytes.data() + at, &value, sizeof value);
}

}  // namespace

void write_scan_cloud(const std::filesystem::path& path, std::uint32_t points) {
    std::vector<char> bytes(kHeader + kRecord * std::size_t{points});
    std::memcpy(bytes.data(), "LASF", 4);
    put<std::uint8_t>(bytes, 24, 1);
    put<std::uint8_t>(bytes, 25, 2);
    put<std::uint16_t>(bytes, 94, kHeader);
    put<std::uint32_t>(bytes, 96, kHeader);
    put<std::uint8_t>(bytes, 104, 2);
    put<std::uint16_t>(bytes, 105, kRecord);
    put<std::uint32_t>(bytes, 107, points);
    for (std::size_t axis = 0; axis < 3; ++axis)
        put<double>(bytes, 131 + 8 * axis, kUnit);
    put<double>(bytes, 155, kEasting);
    put<double>(bytes, 163, kNorthing);
    const auto line = static_cast<std::uint32_t>(std::ceil(std::sqrt(static_cast<double>(points))));
    for (std::uint32_t i = 0; i < points; ++i) {
        const std::uint64_t chance = std::uint64_t{4} * i;
        const double x = (i % line + 0.6 * random_share(chance)) * kSpacing,
                     y = (i / line + 0.6 * random_share(chance + 1)) * kSpacing;
        const Ground ground = ground_at(x, y, random_share(chance + 2));
        const std::size_t at = kHeader + kRecord * std::size_t{i};
        put(bytes, at, static_cast<std::int32_t>(std::lround(x / kUnit)));
        put(bytes, at + 4, static_cast<std::int32_t>(std::lround(y / kUnit)));
        put(bytes, at + 8, static_cast<std::int32_t>(std::lround(ground.height / kUnit)));
        for (std::size_t channel = 0; channel < 3; ++channel)
            put(bytes, at + 20 + 2 * channel, static_cast<std::uint16_t>(ground.colour[channel] * 257));
    }
    std::ofstream file(path, std::ios::binary);
    file.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    file.close();
    if (!file) throw SystemError(path.string() + ": cannot be written");
}

}  // namespace splice::bench
