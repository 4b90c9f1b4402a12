// What drawing takes on a device, measured: for --calibrate, and for the table that captures use without it.
#pragma once

#include "engine/capture/capture.h"

#include <vector>

namespace splice {

struct Calibration {
    DrawCosts costs;
    std::vector<CostSample> samples;  // medians, which the costs are fitted to
};

/// Draws a sphere by its triangles and by surfels, from near and far, and nothing at all, in turn, a second or some.
/// Costs are those of `backend`.
Calibration calibrate(Renderer& renderer, Backend backend);

}  // namespace splice
