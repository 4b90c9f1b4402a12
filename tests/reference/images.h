// The images that the oracle makes and the measures compare.
#pragma once

#include "engine/metrics/raster.h"

#include <limits>

namespace splice::reference {

using metrics::ColourImage;
using metrics::Mask;
using metrics::Raster;
using metrics::Rgb8;

/// Depth of pixels that show nothing.
inline constexpr float kNothing = std::numeric_limits<float>::infinity();

using DepthImage = Raster<float>;  // distance from the eye along the view direction, or kNothing

}  // namespace splice::reference
