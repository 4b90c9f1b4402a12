#include "engine/scene/patch_view.h"

#include "engine/scene/splat_reach.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace splice {

namespace {

// The error of a level of triangles is a root mean square: somewhere they are this many times as far off, about.
constexpr double kWorstOfError = 4;

}  // namespace

PatchView::PatchView(const Camera& camera, std::uint32_t width, std::uint32_t height, const glm::dmat4& model_to_view,
                     double scale)
    : camera_(camera),
      model_to_view_(model_to_view),
      scale_(scale),
      pixel_scale_(splice::pixel_scale(camera, height)),
      half_x_(0.5 * width / pixel_scale_),
      half_y_(0.5 * height / pixel_scale_) {}

PatchView::Extent PatchView::locate(const float (&low)[3], const float (&high)[3]) const {
    const double margin = kPrefilterReach / pixel_scale_;
    std::array<int, 5> outside{};
    std::array<int, 5> inside{};
    double nearest = std::numeric_limits<double>::max();
    glm::dvec2 aside(0);  // |x|, |y| at depth 1
    for (int corner = 0; corner < 8; ++corner) {
        const glm::dvec4 p =
            model_to_view_ * glm::dvec4((corner & 1) ? high[0] : low[0], (corner & 2) ? high[1] : low[1],
                                        (corner & 4) ? high[2] : low[2], 1);
        const double depth = -p.z;
        const double reach = camera_.orthographic ? 1 : depth;
        const std::array<double, 5> beyond{p.x - half_x_ * reach, -p.x - half_x_ * reach, p.y - half_y_ * reach,
                                           -p.y - half_y_ * reach, camera_.near_plane - depth};
        const double slack = margin * std::max(reach, 0.0);
        for (std::size_t plane = 0; plane < beyond.size(); ++plane) {
            outside[plane] += beyond[plane] > (plane < 4 ? slack : 0) ? 1 : 0;
            inside[plane] += beyond[plane] < 0 ? 1 : 0;
        }
        nearest = std::min(nearest, depth);
        aside = glm::max(aside, glm::abs(glm::dvec2(p)) / std::max(depth, camera_.near_plane));
    }
    // Projections of the bounds' corners hold that of the bounds, where all is in front of the eye.
    if (nearest <= camera_.near_plane) aside = {half_x_, half_y_};
    aside = glm::min(aside, {half_x_, half_y_});
    const double stretch = camera_.orthographic ? 1 : std::hypot(1.0, aside.x, aside.y);
    const auto all = [](int corners) { return corners == 8; };
    if (std::any_of(outside.begin(), outside.end(), all)) return {Containment::kOutside, nearest, stretch};
    return {std::all_of(inside.begin(), inside.end(), all) ? Containment::kInside : Containment::kPartly, nearest,
            stretch};
}

bool PatchView::faces_away(const float (&cone_axis)[3], float cone_cosine, const float (&low)[3],
                           const float (&high)[3]) const {
    if (cone_cosine <= 0) return false;
    const glm::dvec3 axis = glm::normalize(glm::dmat3(model_to_view_) * vector_of(cone_axis));
    const double spread = std::acos(std::min(static_cast<double>(cone_cosine), 1.0));
    glm::dvec3 away(0, 0, -1);
    double alpha = 0;
    if (!camera_.orthographic) {
        const glm::dvec3 lowest = vector_of(low), highest = vector_of(high);
        const glm::dvec3 centre(model_to_view_ * glm::dvec4((lowest + highest) * 0.5, 1));
        const double radius = 0.5 * glm::length(highest - lowest) * scale_;
        const double distance = glm::length(centre);
        if (distance <= radius) return false;
        away = centre / distance;
        alpha = std::asin(radius / distance);
    }
    const double beta = std::acos(std::clamp(glm::dot(axis, away), -1.0, 1.0));
    constexpr double kRounding = 1e-3;  // radians; normals are quantised
    return beta + spread + alpha + kRounding < std::acos(-kHorizon);
}

bool PatchView::within(double length, double pixels, const Extent& extent) const {
    if (pixels == 0 || (!camera_.orthographic && extent.nearest <= camera_.near_plane)) return false;
    const double depth = camera_.orthographic ? 1 : extent.nearest;
    return length * pixel_scale_ * scale_ * extent.stretch <= pixels * depth;
}

std::size_t PatchView::levels_within(std::span<const format::Lod> levels, double tau, const Extent& extent) const {
    std::size_t fit = 0;
    while (fit < levels.size() && within(kWorstOfError * static_cast<double>(levels[fit].error), tau, extent))
        ++fit;
    return fit;
}

double PatchView::pixels_of(double area, const float (&low)[3], const float (&high)[3], double nearest) const {
    const double unit = pixel_scale_ * scale_ / (camera_.orthographic ? 1 : std::max(nearest, camera_.near_plane));
    const double all = 4 * half_x_ * half_y_ * pixel_scale_ * pixel_scale_;
    const glm::dvec3 size = vector_of(high) - vector_of(low);
    const double of_box = 0.5 * (size.x * size.y + size.y * size.z + size.z * size.x);
    return std::min((area > 0 ? 0.5 * area : of_box) * unit * unit, all);
}

DrawLoad PatchView::load_of_triangles(const format::Lod& level, double pixels, bool two_sided) {
    // What faces away is not left out: half of what is drawn of a closed surface is culled by the device.
    const double seen = two_sided ? 1 : 0.5;
    const double triangles = level.index_count / 3;
    return {.triangles = triangles,
            .triangle_hits = std::min(seen * triangles, seen * pixels),
            .triangle_pixels = seen * pixels};
}

}  // namespace splice
