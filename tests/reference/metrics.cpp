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

/// Whether any pixel within `radius` of (x, y), inside the image, holds `value`.
bool any_within(const Mask& mask, std::uint32_t x, std::uint32_t y, double radius, std::uint8_t value) {
    const auto reach = static_cast<std::int64_t>(radius);
    for (std::int64_t dy = -reach; dy <= reach; ++dy)
        for (std::int64_t dx = -reach; dx <= reach; ++dx) {
            if (static_cast<double>(dx * dx + dy * dy) > radius * radius) continue;
            const std::int64_t nx = x + dx, ny = y + dy;
            if (nx < 0 || ny < 0 || nx >= mask.width || ny >= mask.height) continue;
            if (mask.at(static_cast<std::uint32_t>(nx), static_cast<std::uint32_t>(ny)) == value) return true;
        }
    return false;
}

template <typename Rule>
Mask map_pixels(const Mask& mask, const Rule& rule) {
    Mask result(mask.width, mask.height);
    for (std::uint32_t y = 0; y < mask.height; ++y)
        for (std::uint32_t x = 0; x < mask.width; ++x)
            result.at(x, y) = rule(x, y) ? 1 : 0;
    return result;
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

Mask eroded(const Mask& mask, double radius) {
    return map_pixels(mask, [&](std::uint32_t x, std::uint32_t y) { return !any_within(mask, x, y, radius, 0); });
}

Mask dilated(const Mask& mask, double radius) {
    return map_pixels(mask, [&](std::uint32_t x, std::uint32_t y) { return any_within(mask, x, y, radius, 1); });
}

double psnr(const ColourImage& image, const ColourImage& reference, const Mask* where) {
    require_same_size(image, reference);
    if (where) require_same_size(image, *where);
    std::uint64_t squares = 0, pixels = 0;
    for (std::size_t i = 0; i < image.pixels.size(); ++i) {
        if (where && !where->pixels[i]) continue;
        const Rgb8 a = image.pixels[i], b = reference.pixels[i];
        const int dr = a.r - b.r, dg = a.g - b.g, db = a.b - b.b;
        squares += static_cast<std::uint64_t>(dr * dr + dg * dg + db * db);
        ++pixels;
    }
    if (pixels == 0) return std::nan("");
    return 10 * std::log10(255.0 * 255.0 * 3.0 * static_cast<double>(pixels) / static_cast<double>(squares));
}

ColourImage difference(const ColourImage& image, const ColourImage& reference, int gain) {
    require_same_size(image, reference);
    ColourImage result(image.width, image.height);
    const auto channel = [&](int a, int b) { return static_cast<std::uint8_t>(std::min(255, gain * std::abs(a - b))); };
    std::transform(image.pixels.begin(), image.pixels.end(), reference.pixels.begin(), result.pixels.begin(),
                   [&](Rgb8 a, Rgb8 b) {
                       return Rgb8{channel(a.r, b.r), channel(a.g, b.g), channel(a.b, b.b)};
                   });
    return result;
}

double silhouette_iou(const Mask& a, const Mask& b) {
    require_same_size(a, b);
    std::uint64_t both = 0, either = 0;
    for (std::size_t i = 0; i < a.pixels.size(); ++i) {
        both += static_cast<std::uint64_t>(a.pixels[i] & b.pixels[i]);
        either += static_cast<std::uint64_t>(a.pixels[i] | b.pixels[i]);
    }
    return either ? static_cast<double>(both) / static_cast<double>(either) : 1.0;
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
