// How hands move the camera: what stays under the cursor, what stays in sight, and that nothing locks.
#include "engine/viewer/camera_controller.h"

#include <catch2/catch.hpp>
#include <glm/gtc/constants.hpp>

#include <cmath>
#include <random>

using namespace splice;

namespace {

constexpr Viewport kViewport{640, 480};

Box unit_box() {
    return {glm::dvec3(-0.5, -0.3, -0.2), glm::dvec3(0.5, 0.3, 0.2)};
}

CameraController framed(bool orthographic = false) {
    CameraController controller;
    controller.set_bounds(unit_box());
    Framing framing;
    framing.orthographic = orthographic;
    controller.set_camera(frame_camera(unit_box(), framing, kViewport.width, kViewport.height));
    return controller;
}

glm::dvec3 where(const CameraController& controller, const glm::dvec3& point) {
    return project(controller.camera(), kViewport.width, kViewport.height, point);
}

void check_near(const glm::dvec3& a, const glm::dvec3& b, double tolerance = 1e-9) {
    INFO(a.x << " " << a.y << " " << a.z << " against " << b.x << " " << b.y << " " << b.z);
    CHECK(glm::length(a - b) <= tolerance);
}

void check_same_window(const glm::dvec3& a, const glm::dvec3& b, double tolerance = 1e-6) {
    INFO(a.x << " " << a.y << " against " << b.x << " " << b.y);
    CHECK(std::hypot(a.x - b.x, a.y - b.y) <= tolerance);
}

void check_shows_all(const CameraController& controller) {
    for (int corner = 0; corner < 8; ++corner) {
        const glm::dvec3 p((corner & 1) ? 0.5 : -0.5, (corner & 2) ? 0.3 : -0.3, (corner & 4) ? 0.2 : -0.2);
        const glm::dvec3 at = where(controller, p);
        CHECK((at.x > 0 && at.x < kViewport.width && at.y > 0 && at.y < kViewport.height));
        CHECK(at.z > controller.camera().near_plane);
        if (controller.orthographic()) CHECK(at.z < controller.camera().far_plane);
    }
}

}  // namespace

TEST_CASE("a camera that is taken over comes back as it was") {
    for (const bool orthographic : {false, true}) {
        Framing framing;
        framing.orthographic = orthographic;
        framing.azimuth_degrees = 123;
        framing.elevation_degrees = -41;
        const Camera camera = frame_camera(unit_box(), framing, kViewport.width, kViewport.height);
        CameraController controller;
        controller.set_bounds(unit_box());
        controller.set_camera(camera);
        for (const glm::dvec3 point : {glm::dvec3(0.5, 0.3, 0.2), glm::dvec3(-0.4, 0.1, -0.2), glm::dvec3(0)})
            check_same_window(where(controller, point), project(camera, kViewport.width, kViewport.height, point));
        CHECK(controller.camera().orthographic == orthographic);
    }
}

TEST_CASE("a ray goes through the pixel that its points project to") {
    for (const bool orthographic : {false, true}) {
        const Camera camera = framed(orthographic).camera();
        const Ray ray = ray_through(camera, kViewport, 123.25, 45.5);
        for (const double distance : {0.5, 1.0, 3.0}) {
            const glm::dvec3 at =
                project(camera, kViewport.width, kViewport.height, ray.origin + ray.direction * distance);
            check_same_window(at, {123.25, 45.5, 0});
        }
    }
}

TEST_CASE("orbiting keeps the pivot where it is on the screen and as far away") {
    for (const OrbitStyle style : {OrbitStyle::kTurntable, OrbitStyle::kTrackball}) {
        CameraController controller = framed();
        controller.set_pivot({0.3, 0.1, 0.15});
        const glm::dvec3 before = where(controller, controller.pivot());
        controller.orbit(77, -31, kViewport, style);
        const glm::dvec3 after = where(controller, controller.pivot());
        check_same_window(before, after);
        CHECK(after.z == Approx(before.z));
    }
}

TEST_CASE("dragging to the right turns the near side to the right, dragging down turns it down") {
    CameraController controller = framed();
    controller.view_from(Side::kFront);
    const glm::dvec3 near_point(0, 0, 0.2);
    const glm::dvec3 before = where(controller, near_point);
    controller.orbit(40, 0, kViewport);
    CHECK(where(controller, near_point).x > before.x + 1);
    controller.view_from(Side::kFront);
    controller.orbit(0, 40, kViewport);
    CHECK(where(controller, near_point).y > before.y + 1);
}

TEST_CASE("an orbit over the poles goes all the way round, and back by the same way") {
    CameraController controller = framed();
    controller.view_from(Side::kFront);
    const glm::dvec3 start = controller.camera().eye;
    for (int i = 0; i < 48; ++i) {
        controller.orbit(0, 20, kViewport);  // 7.5 degrees
        const Camera camera = controller.camera();
        CHECK(glm::length(camera.up) == Approx(1));
        CHECK(std::abs(glm::dot(camera.up, glm::normalize(camera.target - camera.eye))) < 1e-9);
    }
    check_near(controller.camera().eye, start, 1e-9);
    // At the pole, sideways drags still turn the picture.
    controller.view_from(Side::kTop);
    const glm::dvec3 up = controller.camera().up;
    controller.orbit(60, 0, kViewport);
    CHECK(glm::dot(up, controller.camera().up) == Approx(std::cos(glm::pi<double>() * 60 / 480)));
    controller.orbit(-60, 0, kViewport);
    check_near(controller.camera().up, up);
}

TEST_CASE("upside down, a drag to the right still moves the near side to the right") {
    CameraController controller = framed();
    controller.view_from(Side::kFront);
    controller.orbit(0, 400, kViewport);  // 150 degrees over the top
    REQUIRE(controller.camera().up.y < 0);
    const Camera camera = controller.camera();
    const glm::dvec3 near_point = camera.target + glm::normalize(camera.eye - camera.target) * 0.1;
    const glm::dvec3 before = where(controller, near_point);
    controller.orbit(30, 0, kViewport);
    CHECK(where(controller, near_point).x > before.x + 1);
}

TEST_CASE("ten thousand random moves leave a sound camera that sees the scene once framed") {
    for (const OrbitStyle style : {OrbitStyle::kTurntable, OrbitStyle::kTrackball}) {
        CameraController controller = framed();
        std::mt19937 random(7);
        std::uniform_real_distribution<double> pixels(-300, 300);
        for (int i = 0; i < 10000; ++i) {
            controller.orbit(pixels(random), pixels(random), kViewport, style);
            if (i % 7 == 0) controller.roll(pixels(random));
            if (i % 5 == 0) controller.look(pixels(random) / 10, pixels(random) / 10, kViewport);
            if (i % 3 == 0)
                controller.zoom(pixels(random) / 100, pixels(random) + 320, pixels(random) + 240, kViewport);
            if (i % 4 == 0) controller.pan(pixels(random), pixels(random), kViewport);
            const Camera camera = controller.camera();
            REQUIRE_NOTHROW(view_matrix(camera));
            REQUIRE(std::abs(glm::length(camera.up) - 1) < 1e-9);
            REQUIRE(std::isfinite(camera.eye.x));
        }
        controller.frame_all(kViewport);
        check_shows_all(controller);
    }
}

TEST_CASE("panning moves what lies at the pivot's depth with the cursor") {
    for (const bool orthographic : {false, true}) {
        CameraController controller = framed(orthographic);
        controller.set_pivot({0.2, 0.1, 0.1});
        const glm::dvec3 pivot = controller.pivot();
        const glm::dvec3 before = where(controller, pivot);
        controller.pan(33, -21, kViewport);
        check_same_window(where(controller, pivot), before + glm::dvec3(33, -21, 0));
    }
}

TEST_CASE("zooming keeps the point under the cursor and brings it nearer") {
    for (const bool orthographic : {false, true}) {
        CameraController controller = framed(orthographic);
        const glm::dvec3 point(0.31, -0.12, 0.2);
        const glm::dvec3 before = where(controller, point);
        controller.zoom(3, before.x, before.y, kViewport, point);
        const glm::dvec3 after = where(controller, point);
        check_same_window(after, before);
        if (!orthographic) CHECK(after.z == Approx(before.z * std::pow(7.0 / 6, -3)));
        const glm::dvec3 other(0.31, 0.2, 0.2);
        CHECK(std::abs(where(controller, other).y - after.y) >
              std::abs(where(framed(orthographic), other).y - before.y));
        controller.zoom(-3, before.x, before.y, kViewport, point);
        check_same_window(where(controller, point), before);
        check_same_window(where(controller, other), where(framed(orthographic), other));
    }
}

TEST_CASE("zooming without a surface keeps the point at the pivot's depth") {
    CameraController controller = framed();
    const Camera camera = controller.camera();
    const Ray ray = ray_through(camera, kViewport, 100, 400);
    const glm::dvec3 forward = glm::normalize(camera.target - camera.eye);
    const glm::dvec3 point =
        ray.origin + ray.direction * (glm::length(camera.target - camera.eye) / glm::dot(ray.direction, forward));
    controller.zoom(2, 100, 400, kViewport);
    check_same_window(where(controller, point), {100, 400, 0});
}

TEST_CASE("zooming ends before the numbers do") {
    CameraController controller = framed();
    for (int i = 0; i < 500; ++i)
        controller.zoom(5, 320, 240, kViewport);
    CHECK(glm::length(controller.camera().eye - controller.camera().target) > 1e-7);
    for (int i = 0; i < 1000; ++i)
        controller.zoom(-5, 320, 240, kViewport);
    CHECK(glm::length(controller.camera().eye) < 2000 * unit_box().radius());
    controller.frame_all(kViewport);
    check_shows_all(controller);
}

TEST_CASE("a new pivot leaves the picture alone") {
    for (const bool orthographic : {false, true}) {
        CameraController controller = framed(orthographic);
        const glm::dvec3 point(0.4, -0.2, 0.1);
        const glm::dvec3 before = where(controller, point);
        controller.set_pivot({-0.3, 0.25, 0.15});
        check_same_window(where(controller, point), before);
        check_near(controller.pivot(), {-0.3, 0.25, 0.15});
    }
}

TEST_CASE("a pivot behind the eye is refused") {
    CameraController controller = framed();
    const glm::dvec3 pivot = controller.pivot();
    const Camera camera = controller.camera();
    controller.set_pivot(camera.eye + (camera.eye - camera.target));
    check_near(controller.pivot(), pivot);
}

TEST_CASE("axis views look along the axes with the usual side up") {
    CameraController controller = framed();
    struct Expected {
        Side side;
        glm::dvec3 backwards, up;
    };
    for (const Expected& expected :
         {Expected{Side::kFront, {0, 0, 1}, {0, 1, 0}}, Expected{Side::kBack, {0, 0, -1}, {0, 1, 0}},
          Expected{Side::kRight, {1, 0, 0}, {0, 1, 0}}, Expected{Side::kLeft, {-1, 0, 0}, {0, 1, 0}},
          Expected{Side::kTop, {0, 1, 0}, {0, 0, -1}}, Expected{Side::kBottom, {0, -1, 0}, {0, 0, 1}}}) {
        controller.view_from(expected.side);
        const Camera camera = controller.camera();
        check_near(glm::normalize(camera.eye - camera.target), expected.backwards);
        check_near(camera.up, expected.up);
        controller.frame_all(kViewport);
        check_near(glm::normalize(controller.camera().eye - controller.camera().target), expected.backwards);
        check_shows_all(controller);
    }
}

TEST_CASE("switching between parallel and perspective rays keeps the size at the pivot") {
    CameraController controller = framed();
    const Camera camera = controller.camera();
    const glm::dvec3 beside = controller.pivot() + camera.up * 0.2;
    const glm::dvec3 before = where(controller, beside);
    controller.set_orthographic(true);
    check_same_window(where(controller, beside), before);
    // Nothing of the scene is cut, however near the eye would have been.
    controller.zoom(40, 320, 240, kViewport);
    const Camera near_camera = controller.camera();
    for (const glm::dvec3 corner : {unit_box().minimum, unit_box().maximum}) {
        const double depth = project(near_camera, 640, 480, corner).z;
        CHECK(depth > near_camera.near_plane);
        CHECK(depth < near_camera.far_plane);
    }
    controller.zoom(-40, 320, 240, kViewport);
    controller.set_orthographic(false);
    check_same_window(where(controller, beside), before, 1e-5);
}

TEST_CASE("flying moves along the view, looking turns without moving") {
    CameraController controller = framed();
    const Camera before = controller.camera();
    const glm::dvec3 forward = glm::normalize(before.target - before.eye);
    controller.fly({0, 0, 1}, 0.5);
    check_near(controller.camera().eye, before.eye + forward * (0.5 * unit_box().radius()));
    const glm::dvec3 eye = controller.camera().eye;
    controller.look(120, 0, kViewport);
    check_near(controller.camera().eye, eye);
    CHECK(glm::dot(glm::normalize(controller.camera().target - eye), forward) < 0.95);
    controller.fly({1, 0, 0}, 1, 4);
    CHECK(glm::length(controller.camera().eye - eye) == Approx(4 * unit_box().radius()));
}

TEST_CASE("clip planes follow the camera into the scene") {
    CameraController controller = framed();
    for (int i = 0; i < 60; ++i) {
        controller.zoom(1, 320, 240, kViewport, glm::dvec3(0, 0, 0.2));
        CHECK(where(controller, {0, 0, 0.2}).z > controller.camera().near_plane * 0.5);
    }
    const glm::dvec3 point = where(controller, {0, 0, 0.2});
    CHECK(point.z > 0);
}
