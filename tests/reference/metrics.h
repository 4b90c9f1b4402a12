// Holds the surface that a frame shows against the reference; how the colours differ is engine/metrics'.
#pragma once

#include "engine/metrics/image_metrics.h"
#include "tests/reference/images.h"

#include <cstdint>
#include <functional>

namespace splice::reference {

using metrics::any_within;
using metrics::difference;
using metrics::dilated;
using metrics::eroded;
using metrics::psnr;
using metrics::silhouette_iou;

Mask covered(const DepthImage& depth);

/// What the check of a frame against the reference found: counts of pixels that break a rule.
struct SurfaceReport {
    std::uint64_t inside = 0;    // pixels 2 px inside the reference's coverage
    std::uint64_t holes = 0;     // of those: background, or a surface behind the tolerated depth
    std::uint64_t lost = 0;      // reference pixels without cover within 1 px
    std::uint64_t grown = 0;     // covered pixels farther than allowed from any reference pixel
    std::uint64_t in_front = 0;  // covered pixels nearer than the nearest of the 3x3, beyond the tolerance
    double worst_behind = 0;     // largest excess over the tolerated depth among the holes with a surface
    double worst_in_front = 0;   // the same for what is in front; both in unit-box units

    bool clean() const { return holes + lost + grown + in_front == 0; }
};

/// Per-pixel tolerances of the check; see surfel_tolerance.h for how surfels determine them.
struct Tolerance {
    Raster<float> depth;      // 2 epsilon + spacing of the surfels that may show at a pixel, unit-box units
    Raster<float> radius_px;  // radius of the largest of their disks on screen
};

/// The surface anywhere in a pixel: one ray a pixel steps over slivers and cracks, so before a pixel counts as a fault,
/// its neighbourhood is looked at closer.
using RangeInPixel = std::function<DepthRange(std::uint32_t x, std::uint32_t y)>;

/// `frame` and `reference` hold distances along the view direction. The rules:
///  - hole: a pixel 2 px inside the reference that shows nothing, or a surface farther than the farthest reference
///  depth
///    of its 3x3 neighbourhood plus the tolerance;
///  - lost: a reference pixel with no covered pixel within 1 px;
///  - growth: a covered pixel with no reference pixel within max(2, 1 + disk radius) px;
///  - in front: a covered pixel whose depth is less than the nearest of the 3x3 minus the tolerance (where the 3x3
///  holds
///    any reference pixel).
/// `marked`, if given, receives a picture: grey reference, red holes, blue lost, yellow grown, magenta in front.
/// `closer` sees what the reference's rays miss; without it the reference alone decides.
SurfaceReport check_surface(const DepthImage& frame, const DepthImage& reference, const Tolerance& tolerance,
                            ColourImage* marked = nullptr, const RangeInPixel& closer = {});

}  // namespace splice::reference
