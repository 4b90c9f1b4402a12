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

/// Over the covered pixels of the 3x3 neighbourhood.
DepthRange depth_range(const DepthImage& depth, std::uint32_t x, std::uint32_t y) {
    DepthRange range;
    for (std::int64_t dy = -1; dy <= 1; ++dy)
        for (std::int64_t dx = -1; dx <= 1; ++dx) {
            const std::int64_t nx = x + dx, ny = y + dy;
            if (nx < 0 || ny < 0 || nx >= depth.width || ny >= depth.height) continue;
            const float d = depth.at(static_cast<std::uint32_t>(nx), static_cast<std::uint32_t>(ny));
            if (d != kNothing) range.include(d);
        }
    return range;
}

/// The surface in the pixels up to `radius` away along each axis, looked at closer than the reference did until what is
/// found will do.
template <typename WillDo>
DepthRange range_within(const DepthImage& reference, std::uint32_t x, std::uint32_t y, double radius,
                        const RangeInPixel& closer, const WillDo& will_do) {
    const auto reach = static_cast<std::int64_t>(radius);
    DepthRange range;
    for (std::int64_t dy = -reach; dy <= reach; ++dy)
        for (std::int64_t dx = -reach; dx <= reach; ++dx) {
            const std::int64_t nx = x + dx, ny = y + dy;
            if (nx < 0 || ny < 0 || nx >= reference.width || ny >= reference.height) continue;
            const auto px = static_cast<std::uint32_t>(nx), py = static_cast<std::uint32_t>(ny);
            const float centre = reference.at(px, py);
            const DepthRange in_pixel = closer ? closer(px, py) : DepthRange{centre, centre};
            range.include(in_pixel.nearest);
            range.include(in_pixel.farthest);
            if (will_do(range)) return range;
        }
    return range;
}

}  // namespace

Mask covered(const DepthImage& depth) {
    Mask mask(depth.width, depth.height);
    std::transform(depth.pixels.begin(), depth.pixels.end(), mask.pixels.begin(),
                   [](float d) { return d == kNothing ? std::uint8_t{0} : std::uint8_t{1}; });
    return mask;
}

SurfaceReport check_surface(const DepthImage& frame, const DepthImage& reference, const Tolerance& tolerance,
                            ColourImage* marked, const RangeInPixel& closer) {
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
                    const auto tolerated = [&](const DepthRange& range) { return shown <= range.farthest + allowed; };
                    if (shown > farthest + allowed && !tolerated(range_within(reference, x, y, 1, closer, tolerated))) {
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
                const auto tolerated = [&](const DepthRange& range) { return range.nearest <= shown + allowed; };
                const DepthRange range = range_within(reference, x, y, 1, closer, tolerated);
                const float excess = range.nearest - allowed - shown;
                if (!tolerated(range)) {
                    ++report.in_front;
                    report.worst_in_front = std::max(report.worst_in_front, double{excess});
                    mark({255, 0, 255});
                }
            }
            const auto any = [](const DepthRange& range) { return range.nearest != kNothing; };
            if (!any_within(truth, x, y, reach, 1) && !any(range_within(reference, x, y, reach, closer, any))) {
                ++report.grown;
                mark({255, 255, 0});
            }
        }
    return report;
}

}  // namespace splice::reference
