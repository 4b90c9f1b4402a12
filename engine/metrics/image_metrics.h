// How much two pictures differ: what splice-compare, splice-bench and the tests measure with. "Within r pixels" is
// Euclidean between pixel centres throughout. All throw std::invalid_argument when sizes differ.
#pragma once

#include "engine/metrics/raster.h"

#include <cstdint>

namespace splice::metrics {

/// Whether any pixel within `radius` of (x, y), inside the image, holds `value`.
bool any_within(const Mask& mask, std::uint32_t x, std::uint32_t y, double radius, std::uint8_t value);

/// Pixels whose every neighbour within `radius` is set; outside the image counts as set, so that a surface that runs
/// out of the frame is not "near its border" there.
Mask eroded(const Mask& mask, double radius);
/// Pixels with a set neighbour within `radius`.
Mask dilated(const Mask& mask, double radius);

/// Peak signal-to-noise ratio in dB over the three channels of 8-bit sRGB; infinity for equal images. With `where`,
/// over its set pixels only; NaN when there is none.
double psnr(const ColourImage& image, const ColourImage& reference, const Mask* where = nullptr);

/// Brightness = |image - reference| times `gain`, per channel.
ColourImage difference(const ColourImage& image, const ColourImage& reference, int gain = 4);

/// Intersection over union of two coverages; 1 when both are empty.
double silhouette_iou(const Mask& a, const Mask& b);

struct PixelDifferences {
    std::uint64_t pixels = 0;    // that differ in any channel
    int largest = 0;             // of all channels, in levels of 8 bits
    std::uint32_t x = 0, y = 0;  // the first pixel, row by row, that differs so much
};
PixelDifferences count_differences(const ColourImage& image, const ColourImage& reference);

}  // namespace splice::metrics
