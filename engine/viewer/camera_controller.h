// How hands move the camera. Pure: no window, no device, no clock. The orientation is a quaternion, so that no sequence
// of turns locks it or wears it out; the pivot is what orbits turn about and what pans keep under the cursor.
//
// Pixels are the viewport's, y down, (0, 0) its upper left corner.
#pragma once

#include "engine/scene/camera.h"

#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>

#include <cstdint>
#include <optional>

namespace splice {

struct Viewport {
    std::uint32_t width = 1, height = 1;  // pixels
};

/// Where an axis view is seen from.
enum class Side { kFront, kBack, kRight, kLeft, kTop, kBottom };  // +z, -z, +x, -x, +y, -y

enum class OrbitStyle {
    kTurntable,  // sideways about the world's up direction (+y), up and down about the camera's right; over the poles
    kTrackball,  // both about the camera's own axes
};

/// A ray of the picture, in world space; the direction is unit.
struct Ray {
    glm::dvec3 origin, direction;
};
Ray ray_through(const Camera& camera, const Viewport& viewport, double x, double y);

class CameraController {
  public:
    /// Of the scene: bounds what zooming may reach and sets the speed of flying.
    void set_bounds(const Box& bounds) { bounds_ = bounds; }
    const Box& bounds() const { return bounds_; }

    /// Takes over a camera; its target becomes the pivot. Throws UsageError where it has no view.
    void set_camera(const Camera& camera);
    /// Clip planes are fitted to the bounds. An orthographic camera stands back far enough to see all of them.
    Camera camera() const;
    const glm::dvec3& pivot() const { return pivot_; }
    bool orthographic() const { return orthographic_; }

    /// A drag over the viewport's height turns by half a turn.
    void orbit(double dx, double dy, const Viewport& viewport, OrbitStyle style = OrbitStyle::kTurntable);
    /// About the viewing direction, degrees counter-clockwise as seen in the picture.
    void roll(double degrees);
    /// What lies at the pivot's depth follows the cursor.
    void pan(double dx, double dy, const Viewport& viewport);
    /// Positive notches zoom in, each by a sixth. The point under the cursor stays there: `surface` if given, else the
    /// one at the pivot's depth.
    void zoom(double notches, double x, double y, const Viewport& viewport,
              const std::optional<glm::dvec3>& surface = {});
    /// Later orbits turn about it; the picture stays. A pivot behind the eye is refused.
    void set_pivot(const glm::dvec3& pivot);
    /// From the present side, as large as it fits.
    void frame_all(const Viewport& viewport);
    /// Keeps the pivot and its distance.
    void view_from(Side side);
    /// What lies at the pivot's depth keeps its size.
    void set_orthographic(bool orthographic) { orthographic_ = orthographic; }

    /// Turns the head: the eye stays. Pixels as for orbit.
    void look(double dx, double dy, const Viewport& viewport);
    /// Moves the eye along the camera's right, up and forward axes for so many seconds at `speed` times the usual one,
    /// which crosses the scene in two seconds.
    void fly(const glm::dvec3& direction, double seconds, double speed = 1);

  private:
    glm::dvec3 right() const { return orientation_ * glm::dvec3(1, 0, 0); }
    glm::dvec3 up() const { return orientation_ * glm::dvec3(0, 1, 0); }
    glm::dvec3 backwards() const { return orientation_ * glm::dvec3(0, 0, 1); }
    double scale() const { return bounds_.radius() > 0 ? bounds_.radius() : 1; }
    double tangent() const;         // of half the vertical field of view
    double pivot_distance() const;  // along the viewing direction, positive
    double units_per_pixel(const Viewport& viewport) const;
    void turn(const glm::dquat& rotation, const glm::dvec3& centre);

    Box bounds_;
    glm::dquat orientation_{1, 0, 0, 0};  // camera to world axes
    glm::dvec3 eye_{0, 0, 3}, pivot_{0, 0, 0};
    double fov_y_degrees_ = 40;
    bool orthographic_ = false;
};

}  // namespace splice
