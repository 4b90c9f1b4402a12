#include "engine/metrics/image_metrics.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <stdexcept>

namespace splice::metrics {
namespace {

template <typename A, typename B>
void require_same_size(const Raster<A>& a, const Raster<B>& b) {
    if (a.width != b.width || a.height != b.height) throw std::invalid_argument("images of different sizes");
}

template <typename Rule>
Mask map_pixels(const Mask& mask, const Rule& rule) {
    Mask result(mask.width, mask.height);
    for (std::uint32_t y = 0; y < mask.height; ++y)
        for (std::uint32_t x = 0; x < mask.width; ++x)
            result.at(x, y) = rule(x, y) ? 1 : 0;
    return result;
}

}  // namespace

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

PixelDifferences count_differences(const ColourImage& image, const ColourImage& reference) {
    require_same_size(image, reference);
    PixelDifferences found;
    for (std::uint32_t y = 0; y < image.height; ++y)
        for (std::uint32_t x = 0; x < image.width; ++x) {
            const Rgb8 a = image.at(x, y), b = reference.at(x, y);
            const int largest = std::max({std::abs(a.r - b.r), std::abs(a.g - b.g), std::abs(a.b - b.b)});
            if (largest > 0) ++found.pixels;
            if (largest <= found.largest) continue;
            found.largest = largest;
            found.x = x;
            found.y = y;
        }
    return found;
}

}  // namespace splice::metrics
