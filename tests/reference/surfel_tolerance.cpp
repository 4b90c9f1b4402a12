#include "tests/reference/surfel_tolerance.h"

#include "preprocess/model_format/half.h"
#include "preprocess/model_format/surfel_extent.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace splice::reference {
namespace {

std::int64_t clamp_pixel(double position, std::uint32_t size) {
    return static_cast<std::int64_t>(std::clamp(position, -1.0, static_cast<double>(size)));
}

}  // namespace

Tolerance surfel_tolerance(const ModelView& model, const ReferenceView& view, const DepthImage& reference,
                           float epsilon_scale, float floor) {
    const double unit = std::cbrt(std::abs(glm::determinant(glm::dmat3(view.view))));  // uniform scale, mesh -> eye
    Tolerance result{Raster<float>(view.width, view.height, static_cast<float>(floor * unit)),
                     Raster<float>(view.width, view.height, 0.0f)};
    const double focal_px = 0.5 * view.height * std::abs(view.projection[1][1]);
    for (std::uint64_t i = 0; i < model.surfel_count(); ++i) {
        const format::Surfel surfel = model.surfel(i);
        const glm::dvec4 eye = view.view * glm::dvec4(surfel.position[0], surfel.position[1], surfel.position[2], 1);
        const glm::dvec4 clip = view.projection * eye;
        const SurfelExtent extent = decode_extent(surfel.extent, float_from_half(surfel.radius));
        const double radius = float_from_half(surfel.radius) * unit;
        // What is drawn is the solid over and under the disk: in a sphere of this radius.
        const double sphere = std::hypot(radius, std::max(extent.above, extent.below) * unit);
        if (view.perspective() && -eye.z + sphere <= 0) continue;  // behind the eye
        const double nearest = view.perspective() ? std::max(-eye.z - sphere, 1e-6) : 1.0;
        const double w = view.perspective() ? std::max(-eye.z, 1e-6) : clip.w;
        const double cx = (clip.x / w + 1) * 0.5 * view.width, cy = (clip.y / w + 1) * 0.5 * view.height;
        const double radius_px = radius * focal_px / nearest;
        const double depth_tolerance = (2 * epsilon_scale + 1) * extent.epsilon * unit;
        // Its nearer points lie farther from the middle of the picture.
        const double off_axis = std::hypot(cx - 0.5 * view.width, cy - 0.5 * view.height);
        const double spread = view.perspective() ? off_axis * sphere / nearest : 0;
        const double reach = sphere * focal_px / nearest + spread + 1;
        for (std::int64_t y = std::max<std::int64_t>(0, clamp_pixel(cy - reach, view.height));
             y <= std::min<std::int64_t>(view.height - 1, clamp_pixel(cy + reach, view.height)); ++y)
            for (std::int64_t x = std::max<std::int64_t>(0, clamp_pixel(cx - reach, view.width));
                 x <= std::min<std::int64_t>(view.width - 1, clamp_pixel(cx + reach, view.width)); ++x) {
                const double dx = static_cast<double>(x) + 0.5 - cx, dy = static_cast<double>(y) + 0.5 - cy;
                if (dx * dx + dy * dy > reach * reach) continue;
                const auto px = static_cast<std::uint32_t>(x), py = static_cast<std::uint32_t>(y);
                const float surface = reference.at(px, py);
                if (surface != kNothing && -eye.z > surface + 2 * radius + depth_tolerance) continue;
                float& depth = result.depth.at(px, py);
                depth = std::max(depth, static_cast<float>(depth_tolerance));
                float& radius_at = result.radius_px.at(px, py);
                radius_at = std::max(radius_at, static_cast<float>(radius_px));
            }
    }
    return result;
}

}  // namespace splice::reference
