// Cameras that look at hand-made models.
#pragma once

#include "engine/scene/camera.h"

namespace splice::test {

/// At the origin, 60 degrees high.
inline Camera looking_down_z(double near_plane = 0.01) {
    Camera camera;
    camera.eye = {0, 0, 0};
    camera.target = {0, 0, -1};
    camera.fov_y_degrees = 60;
    camera.near_plane = near_plane;
    camera.far_plane = 100;
    return camera;
}

inline Camera parallel(Camera camera, double height = 2) {
    camera.orthographic = true;
    camera.orthographic_height = height;
    return camera;
}

}  // namespace splice::test
