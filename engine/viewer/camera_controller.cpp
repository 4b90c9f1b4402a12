#include "engine/viewer/camera_controller.h"

#include <algorithm>
#include <cmath>

namespace splice {

namespace {

constexpr double kZoomStep = 1.0 / 6;
// Of the scene's radius: nearer, the nearest near plane (fit_clip_planes) would cut; farther, the scene is a dot.
constexpr double kNearest = 5e-4, kFarthest = 1e3;

glm::dmat3 side_axes(Side side) {
    const glm::dvec3 x(1, 0, 0), y(0, 1, 0), z(0, 0, 1);
    switch (side) {
        case Side::kBack:
            return {-x, y, -z};
        case Side::kRight:
            return {-z, y, x};
        case Side::kLeft:
            return {z, y, -x};
        case Side::kTop:
            return {x, -z, y};
        case Side::kBottom:
            return {x, z, -y};
        case Side::kFront:
            break;
    }
    return {x, y, z};
}

}  // namespace

Ray ray_through(const Camera& camera, const Viewport& viewport, double x, double y) {
    const glm::dmat4 to_world = glm::inverse(view_matrix(camera));
    const double scale = pixel_scale(camera, viewport.height);
    const double across = (x - viewport.width * 0.5) / scale, upwards = (viewport.height * 0.5 - y) / scale;
    if (camera.orthographic)
        return {glm::dvec3(to_world * glm::dvec4(across, upwards, 0, 1)), -glm::normalize(glm::dvec3(to_world[2]))};
    return {glm::dvec3(to_world[3]), glm::normalize(glm::dmat3(to_world) * glm::dvec3(across, upwards, -1))};
}

void CameraController::set_camera(const Camera& camera) {
    const glm::dmat3 axes = glm::transpose(glm::dmat3(view_matrix(camera)));
    orientation_ = glm::normalize(glm::quat_cast(axes));
    fov_y_degrees_ = camera.fov_y_degrees;
    orthographic_ = camera.orthographic;
    pivot_ = camera.target;
    eye_ = camera.eye;
    // The height of a parallel picture is kept as the distance at which a perspective one would be as high.
    if (orthographic_) eye_ = pivot_ + backwards() * (camera.orthographic_height / (2 * tangent()));
}

Camera CameraController::camera() const {
    Camera camera;
    const double distance = pivot_distance();
    camera.eye = eye_;
    camera.target = eye_ - backwards() * distance;
    camera.up = up();
    camera.fov_y_degrees = fov_y_degrees_;
    camera.orthographic = orthographic_;
    camera.orthographic_height = 2 * distance * tangent();
    if (orthographic_ && !bounds_.empty()) {
        const double behind = glm::dot(bounds_.centre() - camera.eye, backwards()) + 2 * bounds_.radius();
        camera.eye += backwards() * std::max(behind, 0.0);
    }
    fit_clip_planes(camera, bounds_);
    return camera;
}

double CameraController::tangent() const {
    return std::tan(glm::radians(fov_y_degrees_) / 2);
}

double CameraController::pivot_distance() const {
    return std::max(glm::dot(eye_ - pivot_, backwards()), scale() * kNearest);
}

double CameraController::units_per_pixel(const Viewport& viewport) const {
    return 2 * pivot_distance() * tangent() / viewport.height;
}

void CameraController::turn(const glm::dquat& rotation, const glm::dvec3& centre) {
    eye_ = centre + rotation * (eye_ - centre);
    orientation_ = glm::normalize(rotation * orientation_);
}

void CameraController::orbit(double dx, double dy, const Viewport& viewport, OrbitStyle style) {
    const double angle = glm::pi<double>() / viewport.height;
    glm::dvec3 axis = up();
    if (style == OrbitStyle::kTurntable) {
        // Beyond a pole the picture is upside down, and only the other sense follows the hand.
        axis = glm::dvec3(0, up().y < 0 ? -1 : 1, 0);
    }
    turn(glm::angleAxis(-dy * angle, right()), pivot_);
    turn(glm::angleAxis(-dx * angle, axis), pivot_);
}

void CameraController::roll(double degrees) {
    turn(glm::angleAxis(-glm::radians(degrees), backwards()), eye_);
}

void CameraController::pan(double dx, double dy, const Viewport& viewport) {
    const glm::dvec3 shift = (right() * -dx + up() * dy) * units_per_pixel(viewport);
    eye_ += shift;
    pivot_ += shift;
}

void CameraController::zoom(double notches, double x, double y, const Viewport& viewport,
                            const std::optional<glm::dvec3>& surface) {
    const double distance = pivot_distance();
    const glm::dvec3 at_pivot =
        eye_ - backwards() * distance +
        (right() * (x - viewport.width * 0.5) + up() * (viewport.height * 0.5 - y)) * units_per_pixel(viewport);
    const glm::dvec3 fixed = surface.value_or(at_pivot);
    const double wanted = std::pow(1 + kZoomStep, -notches);
    const double factor = std::clamp(wanted, scale() * kNearest / distance, scale() * kFarthest / distance);
    eye_ = fixed + (eye_ - fixed) * factor;
    pivot_ = fixed + (pivot_ - fixed) * factor;
}

void CameraController::set_pivot(const glm::dvec3& pivot) {
    const double distance = glm::dot(eye_ - pivot, backwards());
    if (!(distance > scale() * kNearest)) return;
    // The size of a parallel picture follows the pivot's distance, so the eye moves with the pivot instead.
    if (orthographic_) eye_ -= backwards() * (distance - pivot_distance());
    pivot_ = pivot;
}

void CameraController::frame_all(const Viewport& viewport) {
    Framing framing;
    framing.fov_y_degrees = fov_y_degrees_;
    framing.orthographic = orthographic_;
    set_camera(frame_camera(bounds_, glm::mat3_cast(orientation_), framing, viewport.width, viewport.height));
}

void CameraController::view_from(Side side) {
    const double distance = pivot_distance();
    orientation_ = glm::normalize(glm::quat_cast(side_axes(side)));
    eye_ = pivot_ + backwards() * distance;
}

void CameraController::look(double dx, double dy, const Viewport& viewport) {
    const double distance = pivot_distance();
    const double angle = glm::pi<double>() / viewport.height;
    turn(glm::angleAxis(-dy * angle, right()), eye_);
    turn(glm::angleAxis(-dx * angle, glm::dvec3(0, up().y < 0 ? -1 : 1, 0)), eye_);
    pivot_ = eye_ - backwards() * distance;
}

void CameraController::fly(const glm::dvec3& direction, double seconds, double speed) {
    const glm::dvec3 shift =
        (right() * direction.x + up() * direction.y - backwards() * direction.z) * (scale() * seconds * speed);
    eye_ += shift;
    pivot_ += shift;
}

}  // namespace splice
