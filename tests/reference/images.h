// The images that the oracle makes and the measures compare.
#pragma once

#include "engine/metrics/raster.h"

#include <algorithm>
#include <limits>

namespace splice::reference {

using metrics::ColourImage;
using metrics::Mask;
using metrics::Raster;
using metrics::Rgb8;

/// Depth of pixels that show nothing.
inline constexpr float kNothing = std::numeric_limits<float>::infinity();

using DepthImage = Raster<float>;  // distance from the eye along the view direction, or kNothing

struct DepthRange {
    float nearest = kNothing, farthest = -kNothing;  // as found: without any ray none; kNothing where rays met nothing

    void include(float depth) {
        nearest = std::min(nearest, depth);
        farthest = std::max(farthest, depth);
    }
};

}  // namespace splice::reference
