#include "engine/capture/camera_path.h"

#include <glm/gtc/matrix_transform.hpp>

#include <algorithm>
#include <cmath>

namespace splice {

namespace {

std::vector<Camera> framed_path(const CaptureCommand& command, Framing framing, const Box& bounds, std::uint32_t width,
                                std::uint32_t height) {
    if (command.fov_degrees) framing.fov_y_degrees = *command.fov_degrees;
    if (command.azimuth_degrees) framing.azimuth_degrees = *command.azimuth_degrees;
    if (command.elevation_degrees) framing.elevation_degrees = *command.elevation_degrees;
    if (command.zoom) framing.zoom = *command.zoom;
    framing.orthographic = framing.orthographic || command.orthographic;
    if (command.orbit == 0) return {frame_camera(bounds, framing, width, height)};

    std::vector<Camera> cameras;
    double distance = 0, size = 0;
    const double start = framing.azimuth_degrees;
    for (std::uint32_t i = 0; i < command.orbit; ++i) {
        framing.azimuth_degrees = start + 360.0 * i / command.orbit;
        cameras.push_back(frame_camera(bounds, framing, width, height));
        distance = std::max(distance, glm::length(cameras.back().eye - bounds.centre()));
        size = std::max(size, cameras.back().orthographic_height);
    }
    for (Camera& camera : cameras) {
        const glm::dvec3 backwards = glm::normalize(camera.eye - camera.target);
        camera.target = bounds.centre();
        camera.eye = camera.target + backwards * distance;
        camera.orthographic_height = size;
    }
    return cameras;
}

// +y; along y, what --azimuth 0 has at the poles: -z seen from above, +z from below.
glm::dvec3 default_up(const glm::dvec3& forward) {
    const double sideways = std::hypot(forward.x, forward.z);
    if (sideways > 1e-9 * glm::length(forward)) return {0, 1, 0};
    return {0, 0, forward.y < 0 ? -1 : 1};
}

}  // namespace

std::vector<Camera> camera_path(const CaptureCommand& command, const SceneDescription& scene, const Box& bounds) {
    const std::uint32_t width = command.size ? command.size->first : scene.width;
    const std::uint32_t height = command.size ? command.size->second : scene.height;
    const bool frames = command.azimuth_degrees || command.elevation_degrees || command.zoom;
    if (!command.eye && (!scene.camera || frames)) return framed_path(command, scene.framing, bounds, width, height);

    Camera camera = scene.camera.value_or(Camera{});
    if (command.eye) {
        camera.eye = *command.eye;
        camera.target = *command.target;
        camera.up = command.up.value_or(default_up(camera.target - camera.eye));
    }
    if (command.fov_degrees) camera.fov_y_degrees = *command.fov_degrees;
    if (command.orthographic_height) {
        camera.orthographic = true;
        camera.orthographic_height = *command.orthographic_height;
    } else if (command.orthographic && !camera.orthographic) {
        // As high as the perspective picture shows at the target.
        camera.orthographic = true;
        camera.orthographic_height =
            2 * glm::length(camera.target - camera.eye) * std::tan(glm::radians(camera.fov_y_degrees) / 2);
    }
    view_matrix(camera);  // throws where there is no view
    std::vector<Camera> cameras;
    for (std::uint32_t i = 0; i < std::max(command.orbit, 1u); ++i) {
        const double angle = command.orbit > 0 ? 2 * glm::pi<double>() * i / command.orbit : 0;
        const glm::dmat4 turn = glm::rotate(glm::dmat4(1.0), angle, glm::normalize(camera.up));
        Camera turned = camera;
        turned.eye = camera.target + glm::dvec3(turn * glm::dvec4(camera.eye - camera.target, 0));
        cameras.push_back(turned);
    }
    return cameras;
}

std::filesystem::path numbered(const std::filesystem::path& path, std::size_t index, std::size_t count) {
    const std::size_t digits = std::max<std::size_t>(std::to_string(count - 1).size(), 3);
    std::string number = std::to_string(index);
    number.insert(0, digits - number.size(), '0');
    std::filesystem::path name = path.stem();
    name += "-" + number + path.extension().string();
    return path.parent_path() / name;
}

}  // namespace splice
