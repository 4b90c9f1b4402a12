#include "engine/capture/numeric_picture.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <string>

namespace splice {

namespace {

using Colour = std::array<std::uint8_t, 3>;

void put(Picture& picture, std::uint32_t x, std::uint32_t y, const Colour& colour) {
    if (x >= picture.width || y >= picture.height) return;
    std::uint8_t* texel = &picture.rgba[4 * (std::size_t{y} * picture.width + x)];
    std::copy(colour.begin(), colour.end(), texel);
    texel[3] = 255;
}

std::uint8_t byte_of(double level) {
    return static_cast<std::uint8_t>(std::lround(std::clamp(level, 0.0, 1.0) * 255));
}

// Blue, cyan, green, yellow, red.
Colour heat(double level) {
    const double h = std::clamp(level, 0.0, 1.0) * 4;
    return {byte_of(std::clamp(h - 2, 0.0, 1.0)),
            byte_of(h < 2 ? std::clamp(h, 0.0, 1.0) : std::clamp(4 - h, 0.0, 1.0)),
            byte_of(std::clamp(2 - h, 0.0, 1.0))};
}

// 3x5 glyphs of 0 to 9 and +, one octal digit a row, the leftmost pixel in the highest bit.
constexpr std::array<std::array<std::uint8_t, 5>, 11> kGlyphs{{{7, 5, 5, 5, 7},
                                                               {2, 6, 2, 2, 7},
                                                               {7, 1, 7, 4, 7},
                                                               {7, 1, 7, 1, 7},
                                                               {5, 5, 7, 1, 1},
                                                               {7, 4, 7, 1, 7},
                                                               {7, 4, 7, 5, 7},
                                                               {7, 1, 1, 1, 1},
                                                               {7, 5, 7, 5, 7},
                                                               {7, 5, 7, 1, 7},
                                                               {0, 2, 7, 2, 0}}};

void write_label(Picture& picture, std::uint32_t x, std::uint32_t y, std::uint32_t scale, const std::string& label,
                 const Colour& ink) {
    for (const char c : label) {
        const auto& rows = kGlyphs[c == '+' ? 10 : static_cast<std::size_t>(c - '0')];
        for (std::uint32_t row = 0; row < 5 * scale; ++row)
            for (std::uint32_t column = 0; column < 3 * scale; ++column)
                if ((rows[row / scale] >> (2 - column / scale)) & 1) put(picture, x + column, y + row, ink);
        x += 4 * scale;
    }
}

void fill(Picture& picture, std::uint32_t x, std::uint32_t y, std::uint32_t width, std::uint32_t height,
          const Colour& colour) {
    for (std::uint32_t row = 0; row < height; ++row)
        for (std::uint32_t column = 0; column < width; ++column)
            put(picture, x + column, y + row, colour);
}

// A bar from 1 (bottom) to `top` at the left edge, with up to five labels; a + says that some pixels have more.
void add_legend(Picture& picture, std::uint32_t top, bool more) {
    const std::uint32_t scale = std::max(1u, picture.height / 256);
    const std::uint32_t margin = 4 * scale, width = 8 * scale, first_row = margin + 3 * scale;
    if (picture.height < 16 * margin) return;
    const std::uint32_t height = picture.height - 2 * first_row;
    const auto characters = static_cast<std::uint32_t>(std::to_string(top).size()) + (more ? 1 : 0);
    fill(picture, 0, 0, margin + width + scale * (4 * characters + 3), picture.height, {255, 255, 255});
    for (std::uint32_t row = 0; row < height; ++row)
        fill(picture, margin, first_row + row, width, 1, heat(1.0 - static_cast<double>(row) / (height - 1)));
    const std::uint32_t steps = std::min(top - 1, 4u);
    for (std::uint32_t step = 0; step <= steps; ++step) {
        const std::uint32_t count = steps == 0 ? top : 1 + (top - 1) * step / steps;
        const double level = top == 1 ? 0 : static_cast<double>(count - 1) / (top - 1);
        const auto row = static_cast<std::uint32_t>(std::lround((1 - level) * (height - 1)));
        write_label(picture, margin + width + 2 * scale, first_row + row - 2 * scale, scale,
                    std::to_string(count) + (more && count == top ? "+" : ""), {0, 0, 0});
    }
}

// The count that all but a few pixels stay within, so that outliers do not take the colours from the others.
std::uint32_t usual_most(std::span<const float> counts) {
    constexpr double kShare = 0.995;
    std::vector<float> sorted;
    std::copy_if(counts.begin(), counts.end(), std::back_inserter(sorted),
                 [](float count) { return std::isfinite(count) && count >= 1; });
    if (sorted.empty()) return 0;
    const auto nth = sorted.begin() + static_cast<std::ptrdiff_t>(kShare * static_cast<double>(sorted.size() - 1));
    std::nth_element(sorted.begin(), nth, sorted.end());
    return static_cast<std::uint32_t>(*nth);
}

Colour overlap_colour(double count, std::uint32_t top) {
    if (count == 0) return {160, 160, 160};
    return heat(top > 1 ? (count - 1) / (top - 1) : 0);
}

}  // namespace

Picture picture_of_numbers(View view, std::span<const float> values, std::uint32_t width, std::uint32_t height,
                           const std::uint8_t (&background)[4]) {
    Picture picture{width, height, std::vector<std::uint8_t>(std::size_t{4} * width * height)};
    double least = std::numeric_limits<double>::infinity(), most = 0;
    for (const float value : values) {
        if (!std::isfinite(value)) continue;
        least = std::min(least, std::abs(static_cast<double>(value)));
        most = std::max(most, std::abs(static_cast<double>(value)));
    }
    const std::uint32_t usual = view == View::kOverlap ? usual_most(values) : 0;
    for (std::size_t i = 0; i < values.size(); ++i) {
        const auto x = static_cast<std::uint32_t>(i % width), y = static_cast<std::uint32_t>(i / width);
        if (!std::isfinite(values[i])) {
            std::copy(std::begin(background), std::end(background), &picture.rgba[4 * i]);
            continue;
        }
        const double value = std::abs(static_cast<double>(values[i]));
        if (view == View::kOverlap) {
            put(picture, x, y, overlap_colour(value, usual));
            continue;
        }
        const double nearness = most > least ? (most - value) / (most - least) : 1;
        const double level = 0.1 + 0.9 * nearness;
        const bool surfel = view == View::kVisibility && values[i] < 0;
        put(picture, x, y,
            {byte_of(level), byte_of(surfel ? level * 0.75 : level), byte_of(surfel ? level * 0.45 : level)});
    }
    if (usual > 0) add_legend(picture, usual, most > usual);
    return picture;
}

}  // namespace splice
