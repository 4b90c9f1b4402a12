// Holes of one frame, as another shows where there is a surface.
#pragma once

#include "engine/capture/capture.h"
#include "engine/metrics/image_metrics.h"

#include <cstddef>

namespace splice::test {

/// Pixels that `full` covers and `coarser` does not, but for those at the outline: specks, which show at the pixel that
/// holds their centre, grow that by up to half a pixel, and ellipses that stand for many of them do not; and disks
/// overhang it, triangles that take their place do not.
inline std::size_t holes(const Frame& full, const Frame& coarser) {
    metrics::Mask covered(full.width, full.height);
    for (std::size_t i = 0; i < full.coverage.size(); ++i)
        covered.pixels[i] = full.coverage[i] != 0;
    const metrics::Mask inside = metrics::eroded(covered, 2);
    std::size_t count = 0;
    for (std::size_t i = 0; i < full.coverage.size(); ++i)
        count += inside.pixels[i] != 0 && coarser.coverage[i] == 0;
    return count;
}

}  // namespace splice::test
