// A frame as image metrics take it.
#pragma once

#include "engine/capture/capture.h"
#include "engine/metrics/image_metrics.h"

#include <cstddef>

namespace splice::test {

inline metrics::ColourImage colours_of(const Frame& frame) {
    metrics::ColourImage image(frame.width, frame.height);
    for (std::size_t i = 0; i < image.pixels.size(); ++i)
        image.pixels[i] = {frame.rgba[4 * i], frame.rgba[4 * i + 1], frame.rgba[4 * i + 2]};
    return image;
}

}  // namespace splice::test
