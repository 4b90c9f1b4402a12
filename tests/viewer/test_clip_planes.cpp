// What is in front of the eye is between the clip planes, wherever hands take the camera.
#include "engine/viewer/camera_controller.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <random>

using namespace splice;

namespace {

constexpr Viewport kViewport{640, 480};

// Depths of all points of the box are between these; corners tell, as depth is linear.
struct Depths {
    double nearest = 1e300, farthest = -1e300;
};
Depths depths_of(const Camera& camera, const Box& box) {
    const glm::dvec3 forward = glm::normalize(camera.target - camera.eye);
    Depths depths;
    for (int corner = 0; corner < 8; ++corner) {
        const glm::dvec3 p((corner & 1) ? box.maximum.x : box.minimum.x, (corner & 2) ? box.maximum.y : box.minimum.y,
                           (corner & 4) ? box.maximum.z : box.minimum.z);
        const double depth = glm::dot(p - camera.eye, forward);
        depths.nearest = std::min(depths.nearest, depth);
        depths.farthest = std::max(depths.farthest, depth);
    }
    return depths;
}

// Of the scene's radius: nearer than so, next to the eye, there is always a plane.
constexpr double kNextToTheEye = 2e-4;

void check_planes(const Camera& camera, const Box& box) {
    const Depths depths = depths_of(camera, box);
    CAPTURE(camera.eye.x, camera.eye.y, camera.eye.z, camera.orthographic, camera.near_plane, camera.far_plane,
            depths.nearest, depths.farthest);
    REQUIRE(camera.near_plane > 0);
    const double slack = 1e-9 * (glm::length(camera.eye - box.centre()) + box.radius());
    if (camera.orthographic) {
        // Parallel rays start before everything and end behind it.
        CHECK(camera.near_plane <= depths.nearest + slack);
        CHECK(camera.far_plane >= depths.farthest - slack);
        CHECK(camera.far_plane > camera.near_plane);
    } else {
        CHECK(camera.near_plane <= std::max(depths.nearest, kNextToTheEye * box.radius()) + slack);
    }
    // Nor is precision given away: outside, the near plane is not far before the scene.
    if (depths.nearest > box.radius()) CHECK(camera.near_plane > 0.4 * depths.nearest);
}

}  // namespace

TEST_CASE("no camera of a long random walk clips the model: outside, inside, far away, parallel and not") {
    for (const double size : {1e-3, 1.0, 1e5}) {
        const Box box{glm::dvec3(-0.5, -0.3, -0.2) * size, glm::dvec3(0.7, 0.3, 0.2) * size};
        std::mt19937 random(7);
        std::uniform_real_distribution<double> pixel(-300, 300), place(0, 480), unit(0, 1);
        CameraController controller;
        controller.set_bounds(box);
        controller.set_camera(frame_camera(box, {}, kViewport.width, kViewport.height));
        int inside = 0, far = 0, parallel = 0;
        for (int i = 0; i < 20000; ++i) {
            switch (random() % 8) {
                case 0:
                    controller.orbit(pixel(random), pixel(random), kViewport,
                                     random() % 2 ? OrbitStyle::kTrackball : OrbitStyle::kTurntable);
                    break;
                case 1:
                    controller.pan(pixel(random), pixel(random), kViewport);
                    break;
                case 2:
                    controller.zoom(unit(random) * 24 - 11, place(random), place(random), kViewport);
                    break;
                case 3:
                    controller.look(pixel(random), pixel(random), kViewport);
                    break;
                case 4:
                    controller.fly({unit(random) - 0.5, unit(random) - 0.5, unit(random) - 0.3}, unit(random));
                    break;
                case 5:
                    controller.set_pivot(box.minimum + (box.maximum - box.minimum) * unit(random));
                    break;
                case 6:
                    controller.set_orthographic(random() % 3 == 0);
                    break;
                default:
                    if (random() % 8 == 0) controller.frame_all(kViewport);
                    break;
            }
            const Camera camera = controller.camera();
            check_planes(camera, box);
            const glm::dvec3 eye = camera.eye;
            const bool in = glm::all(glm::greaterThan(eye, box.minimum)) && glm::all(glm::lessThan(eye, box.maximum));
            inside += !camera.orthographic && in ? 1 : 0;
            far += glm::length(eye - box.centre()) > 20 * box.radius() ? 1 : 0;
            parallel += camera.orthographic ? 1 : 0;
        }
        // The walk was where it should have been.
        CHECK(inside > 20);
        CHECK(far > 100);
        CHECK(parallel > 1000);
    }
}
