// Pictures as plain arrays, for whoever measures them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace splice::metrics {

/// Row-major, rows top to bottom.
template <typename Pixel>
struct Raster {
    std::uint32_t width = 0, height = 0;
    std::vector<Pixel> pixels;

    Raster() = default;
    Raster(std::uint32_t w, std::uint32_t h, Pixel fill = {}) : width(w), height(h), pixels(std::size_t{w} * h, fill) {}
    Pixel& at(std::uint32_t x, std::uint32_t y) { return pixels[std::size_t{y} * width + x]; }
    const Pixel& at(std::uint32_t x, std::uint32_t y) const { return pixels[std::size_t{y} * width + x]; }
};

struct Rgb8 {
    std::uint8_t r = 0, g = 0, b = 0;
    bool operator==(const Rgb8&) const = default;
};

using ColourImage = Raster<Rgb8>;   // sRGB-encoded
using Mask = Raster<std::uint8_t>;  // 0 or 1

}  // namespace splice::metrics
