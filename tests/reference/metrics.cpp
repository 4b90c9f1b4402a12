#include "tests/reference/metrics.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <stdexcept>

namespace splice::reference {
namespace {

template <typename A, typename B>
void require_same_size(const Raster<A>& a, const Raster<B>& b) {
    if (a.width != b.width || a.height != b.height) throw std::invalid_argument("images of different sizes");
}

struct DepthRange {
    float nearest = kNothing, farthest = -kNothing;
};

/// Over the covered pixels of the 3x3 neighbourhood.
DepthRange depth_range(const DepthImage& depth, std::uint32_t x, std::uint32_t y) {
    DepthRange range;
    for (std::int64_t dy = -1; dy <= 1; ++dy)
        for (std::int64_t dx = -1; dx <= 1; ++dx) {
            const std::int64_t nx = x + dx, ny = y + dy;
            if (nx < 0 || ny < 0 || nx >= depth.width || ny >= depth.height) continue;
            const float d = depth.at(static_cast<std::uint32_t>(nx), static_cast<std::uint32_t>(ny));
            if (d == kNothing) continue;
            range.nearest = std::min(range.nearest, d);
            range.farthest = std::max(range.farthest, d);
        }
    return range;
}

/// How near the surface comes in the pixels up to `radius` away along each axis, looked at closer than the reference
/// did until something is found that is `near_enough`.
float nearest_within(const DepthImage& reference, std::uint32_t x, std::uint32_t y, double radius, float near_enough,
                     const NearestInPixel& closer) {
    const auto reach = static_cast<std::int64_t>(radius);
    float nearest = kNothing;
    for (std::int64_t dy = -reach; dy <= reach && nearest > near_enough; ++dy)
        for (std::int64_t dx = -reach; dx <= reach && nearest > near_enough; ++dx) {
            const std::int64_t nx = x + dx, ny = y + dy;
            if (nx < 0 || ny < 0 || nx >= reference.width || ny >= reference.height) continue;
            const auto px = static_cast<std::uint32_t>(nx), py = static_cast<std::uint32_t>(ny);
            nearest = std::min(nearest, closer ? closer(px, py) : reference.at(px, py));
        }
    return nearest;
}

}  // namespace

Mask covered(const DepthImage& depth) {
    Mask mask(depth.width, depth.height);
    std::transform(depth.pixels.begin(), depth.pixels.end(), mask.pixels.begin(),
                   [](float d) { return d == kNothing ? std::uint8_t{0} : std::uint8_t{1}; });
    return mask;
}

SurfaceReport check_surface(const DepthImage& frame, const DepthImage& reference, const Tolerance& tolerance,
                            ColourImage* marked, const NearestInPixel& closer) {
    require_same_size(frame, reference);
    require_same_size(frame, tolerance.depth);
    require_same_size(frame, tolerance.radius_px);
    const Mask truth = covered(reference), cover = covered(frame);
    if (marked) *marked = ColourImage(frame.width, frame.height);

    SurfaceReport report;
    for (std::uint32_t y = 0; y < frame.height; ++y)
        for (std::uint32_t x = 0; x < frame.width; ++x) {
            const auto [nearest, farthest] = depth_range(reference, x, y);
            const float shown = frame.at(x, y), allowed = tolerance.depth.at(x, y);
            const auto mark = [&](Rgb8 colour) {
                if (marked) marked->at(x, y) = colour;
            };
            if (truth.at(x, y)) {
                mark({80, 80, 80});
                if (!any_within(cover, x, y, 1, 1)) {
                    ++report.lost;
                    mark({0, 80, 255});
                }
                if (!any_within(truth, x, y, 2, 0)) {
                    ++report.inside;
                    if (shown > farthest + allowed) {
                        ++report.holes;
                        if (shown != kNothing)
                            report.worst_behind = std::max(report.worst_behind, double{shown} - farthest - allowed);
                        mark({255, 0, 0});
                    }
                }
            }
            if (shown == kNothing) continue;
            const double reach = std::max(2.0, 1.0 + tolerance.radius_px.at(x, y));
            if (nearest != kNothing && shown < nearest - allowed) {
                const float excess = nearest_within(reference, x, y, 1, shown + allowed, closer) - allowed - shown;
                if (excess > 0) {
                    ++report.in_front;
                    report.worst_in_front = std::max(report.worst_in_front, double{excess});
                    mark({255, 0, 255});
                }
            }
            if (!any_within(truth, x, y, reach, 1) &&
                nearest_within(reference, x, y, reach, std::numeric_limits<float>::max(), closer) == kNothing) {
                ++report.grown;
                mark({255, 255, 0});
            }
        }
    return report;
}

}  // namespace splice::reference
