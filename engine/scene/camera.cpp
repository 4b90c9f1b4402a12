#include "engine/scene/camera.h"

#include "preprocess/model_format/error.h"

#include <glm/gtc/matrix_transform.hpp>

#include <algorithm>
#include <cmath>

namespace splice {

namespace {

// Where the view-space box's corners end, which is all that framing and clip planes need.
template <typename Visit>
void for_each_corner(const Box& box, Visit&& visit) {
    for (int corner = 0; corner < 8; ++corner)
        visit(glm::dvec3((corner & 1) ? box.maximum.x : box.minimum.x, (corner & 2) ? box.maximum.y : box.minimum.y,
                         (corner & 4) ? box.maximum.z : box.minimum.z));
}

}  // namespace

Camera frame_camera(const Box& bounds, const Framing& framing, std::uint32_t width, std::uint32_t height) {
    const double azimuth = glm::radians(framing.azimuth_degrees);
    const double elevation = glm::radians(std::clamp(framing.elevation_degrees, -90.0, 90.0));
    const glm::dvec3 backwards(std::sin(azimuth) * std::cos(elevation), std::sin(elevation),
                               std::cos(azimuth) * std::cos(elevation));
    // At the poles the azimuth alone tells which way is up.
    const glm::dvec3 up(-std::sin(azimuth) * std::sin(elevation), std::cos(elevation),
                        -std::cos(azimuth) * std::sin(elevation));
    return frame_camera(bounds, glm::dmat3(glm::cross(up, backwards), up, backwards), framing, width, height);
}

Camera frame_camera(const Box& bounds, const glm::dmat3& orientation, const Framing& framing, std::uint32_t width,
                    std::uint32_t height) {
    const glm::dvec3 right = orientation[0], up = orientation[1], backwards = orientation[2];
    const Box shown = bounds.empty() ? Box{glm::dvec3(-0.5), glm::dvec3(0.5)} : bounds;
    const double radius = std::max(shown.radius(), 1e-12);
    const double aspect = static_cast<double>(width) / static_cast<double>(height);
    const double usable = std::max(1 - 2 * framing.margin, 0.01);  // of the half picture

    Camera camera;
    // Zooming narrows the field of view, which keeps the perspective and scales the picture exactly.
    const double tangent = std::tan(glm::radians(framing.fov_y_degrees) / 2);
    camera.fov_y_degrees = glm::degrees(2 * std::atan(tangent / framing.zoom));
    camera.orthographic = framing.orthographic;
    camera.up = up;
    glm::dvec3 centre = shown.centre();
    double distance = 4 * radius;  // of parallel rays, any will do
    if (framing.orthographic) {
        double half_width = 0, half_height = 0;
        for_each_corner(shown, [&](const glm::dvec3& corner) {
            half_width = std::max(half_width, std::abs(glm::dot(corner - centre, right)));
            half_height = std::max(half_height, std::abs(glm::dot(corner - centre, up)));
        });
        const double half = std::max({half_height, half_width / aspect, radius * 1e-3});
        camera.orthographic_height = 2 * half / usable / framing.zoom;
    } else {
        // A corner at (x, y, z) relative to the centre needs distance >= z + |y| / tangent; at that distance the box's
        // picture is moved to the middle, which changes the distance, and so on for a few rounds.
        const double tangent_y = tangent * usable, tangent_x = tangent_y * aspect;
        const auto needed_distance = [&] {
            double needed = radius * 1e-3;
            for_each_corner(shown, [&](const glm::dvec3& corner) {
                const glm::dvec3 p = corner - centre;
                needed = std::max(needed, glm::dot(p, backwards) + std::max(std::abs(glm::dot(p, right)) / tangent_x,
                                                                            std::abs(glm::dot(p, up)) / tangent_y));
            });
            return needed;
        };
        distance = needed_distance();
        for (int round = 0; round < 12; ++round) {
            Box picture;
            for_each_corner(shown, [&](const glm::dvec3& corner) {
                const glm::dvec3 p = corner - centre;
                const double depth = std::max(distance - glm::dot(p, backwards), radius * 1e-6);
                picture.extend({glm::dot(p, right) / depth, glm::dot(p, up) / depth, 0});
            });
            // The nearer side moves more than the farther one: less than the whole way keeps from overshooting.
            const glm::dvec3 middle = picture.centre() * (0.7 * distance);
            centre += right * middle.x + up * middle.y;
            distance = needed_distance();
        }
    }
    camera.target = centre;
    camera.eye = centre + backwards * distance;
    fit_clip_planes(camera, shown);
    return camera;
}

void fit_clip_planes(Camera& camera, const Box& bounds) {
    const double radius = std::max(bounds.radius(), 1e-12);
    const glm::dvec3 forward = glm::normalize(camera.target - camera.eye);
    double nearest = 1e300, farthest = -1e300;
    for_each_corner(bounds.empty() ? Box{camera.eye, camera.eye} : bounds, [&](const glm::dvec3& corner) {
        const double depth = glm::dot(corner - camera.eye, forward);
        nearest = std::min(nearest, depth);
        farthest = std::max(farthest, depth);
    });
    // A plane that is too near costs nothing with reversed floating-point depth; one that is too far cuts. The floor
    // is for eyes inside the scene.
    camera.near_plane = std::max(nearest * 0.5, radius * 1e-4);
    // Depth that is moved back by epsilon must still fit.
    camera.far_plane = std::max(farthest, camera.near_plane) + radius;
}

glm::dmat4 view_matrix(const Camera& camera) {
    const glm::dvec3 forward = camera.target - camera.eye;
    const double turn = glm::length(glm::cross(forward, camera.up));
    if (!(turn > 1e-9 * glm::length(forward) * glm::length(camera.up)))
        throw UsageError(
            "the camera's eye, target and up direction do not define a view: eye equals target, or up is "
            "parallel to the viewing direction");
    return glm::lookAtRH(camera.eye, camera.target, camera.up);
}

double pixel_scale(const Camera& camera, std::uint32_t height) {
    if (camera.orthographic) return height / camera.orthographic_height;
    return height / (2 * std::tan(glm::radians(camera.fov_y_degrees) / 2));
}

glm::dmat4 projection_matrix(const Camera& camera, std::uint32_t width, std::uint32_t height) {
    const double scale = pixel_scale(camera, height);
    const double near = camera.near_plane, far = camera.far_plane;
    glm::dmat4 m(0.0);
    m[0][0] = 2 * scale / width;
    m[1][1] = -2 * scale / height;
    if (camera.orthographic) {
        m[2][2] = 1 / (far - near);  // z is -depth
        m[3][2] = far / (far - near);
        m[3][3] = 1;
    } else {
        m[3][2] = near;
        m[2][3] = -1;
    }
    return m;
}

glm::dvec3 project(const Camera& camera, std::uint32_t width, std::uint32_t height, const glm::dvec3& world) {
    const glm::dvec4 p = view_matrix(camera) * glm::dvec4(world, 1);
    const double scale = pixel_scale(camera, height) / (camera.orthographic ? 1 : -p.z);
    return {width * 0.5 + p.x * scale, height * 0.5 - p.y * scale, -p.z};
}

}  // namespace splice
