// Pictures of the numeric views: depth and visibility as grey levels, overlap as a heat map with a legend.
#pragma once

#include "engine/capture/png_file.h"
#include "engine/scene/view.h"

#include <cstdint>
#include <span>

namespace splice {

/// `values`: what the frame's numeric picture holds (infinite: nothing there). Uncovered pixels get `background`
/// (sRGB RGBA). Depth: near is bright; visibility: the same, surfels' pixels (negative values) tinted orange; overlap:
/// blue is one surfel, red what all but one pixel in 200 stay within, triangles grey.
Picture picture_of_numbers(View view, std::span<const float> values, std::uint32_t width, std::uint32_t height,
                           const std::uint8_t (&background)[4]);

}  // namespace splice
