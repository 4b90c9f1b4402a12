// The camera: where the eye is and how it projects, and the numbers the passes derive from that. World space is
// right-handed and in source units (the coordinates of the model's file); view space has x right, y up and looks along
// -z; the depth of a point is -z of view space. Window coordinates are pixels, y down, (0, 0) the upper left corner.
#pragma once

#include <glm/glm.hpp>

#include <cstdint>

namespace splice {

struct Camera {
    glm::dvec3 eye{0, 0, 3};
    glm::dvec3 target{0, 0, 0};
    glm::dvec3 up{0, 1, 0};          // must not be parallel to target - eye
    double fov_y_degrees = 40;       // full vertical angle of a perspective camera, (0, 180)
    bool orthographic = false;       // parallel rays
    double orthographic_height = 2;  // world units that the picture is high
    double near_plane = 1e-3;        // depth in world units, > 0; nothing nearer is drawn
    double far_plane = 1e3;          // orthographic only; perspective depth is infinite
    friend bool operator==(const Camera&, const Camera&) = default;
};

/// An axis-aligned box in world space; empty when minimum > maximum.
struct Box {
    glm::dvec3 minimum{1e300};
    glm::dvec3 maximum{-1e300};
    bool empty() const { return minimum.x > maximum.x; }
    glm::dvec3 centre() const { return (minimum + maximum) * 0.5; }
    double radius() const { return empty() ? 0.0 : glm::length(maximum - minimum) * 0.5; }
    void extend(const glm::dvec3& point) {
        minimum = glm::min(minimum, point);
        maximum = glm::max(maximum, point);
    }
};

/// The direction a default view comes from. Azimuth turns about +y, 0 looks along -z (the eye is on +z), 90 looks along
/// -x; elevation lifts the eye, in (-90, 90] and beyond is clamped. Both in degrees.
struct Framing {
    double azimuth_degrees = 30;
    double elevation_degrees = 20;
    double zoom = 1;  // 2 shows everything twice as large
    double fov_y_degrees = 40;
    bool orthographic = false;
    double margin = 0.04;  // share of the picture left free at each side of the bounding box's projection
};

/// The camera that shows `bounds` as large as `framing` and the picture's aspect allow.
Camera frame_camera(const Box& bounds, const Framing& framing, std::uint32_t width, std::uint32_t height);

/// The same for any orientation: columns right, up and backwards of the camera, orthonormal, in world space; the
/// framing's angles do not count.
Camera frame_camera(const Box& bounds, const glm::dmat3& orientation, const Framing& framing, std::uint32_t width,
                    std::uint32_t height);

/// Sets near_plane and far_plane so that `bounds` is inside wherever it is in front of the eye.
void fit_clip_planes(Camera& camera, const Box& bounds);

/// World to view space. Throws UsageError if eye, target and up do not span a view.
glm::dmat4 view_matrix(const Camera& camera);

/// Window pixels per unit at depth 1 (perspective: eta of the thesis's equation 3.24) or anywhere (orthographic).
double pixel_scale(const Camera& camera, std::uint32_t height);

/// View space to Vulkan clip space, y down, reversed depth: perspective near/depth, without a far plane; orthographic
/// (far - depth) / (far - near).
glm::dmat4 projection_matrix(const Camera& camera, std::uint32_t width, std::uint32_t height);

/// Window position (pixels) and depth of a world point; z is the depth, also behind the eye (then x, y mean nothing).
glm::dvec3 project(const Camera& camera, std::uint32_t width, std::uint32_t height, const glm::dvec3& world);

}  // namespace splice
