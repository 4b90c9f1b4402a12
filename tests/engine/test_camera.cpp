#include "engine/scene/camera.h"
#include "preprocess/model_format/error.h"

#include <catch2/catch.hpp>

using namespace splice;

namespace {

std::vector<glm::dvec3> corners_of(const Box& box) {
    std::vector<glm::dvec3> corners;
    for (int i = 0; i < 8; ++i)
        corners.emplace_back((i & 1) ? box.maximum.x : box.minimum.x, (i & 2) ? box.maximum.y : box.minimum.y,
                             (i & 4) ? box.maximum.z : box.minimum.z);
    return corners;
}

}  // namespace

TEST_CASE("a framing camera shows the whole box and touches the margin on one axis, from every side") {
    const Box box{{-1, 2, 10}, {3, 3, 12}};
    for (const bool orthographic : {false, true}) {
        for (const auto& [width, height] : {std::pair{300u, 300u}, std::pair{640u, 200u}, std::pair{100u, 400u}}) {
            for (int azimuth = -180; azimuth <= 180; azimuth += 45) {
                for (int elevation = -90; elevation <= 90; elevation += 30) {
                    CAPTURE(orthographic, width, height, azimuth, elevation);
                    Framing framing;
                    framing.azimuth_degrees = azimuth;
                    framing.elevation_degrees = elevation;
                    framing.orthographic = orthographic;
                    const Camera camera = frame_camera(box, framing, width, height);
                    double x_reach = 0, y_reach = 0;
                    for (const glm::dvec3& corner : corners_of(box)) {
                        const glm::dvec3 p = project(camera, width, height, corner);
                        x_reach = std::max(x_reach, std::abs(p.x / width * 2 - 1));
                        y_reach = std::max(y_reach, std::abs(p.y / height * 2 - 1));
                        CHECK(p.z > camera.near_plane);
                        if (orthographic) CHECK(p.z < camera.far_plane);
                    }
                    const double allowed = 1 - 2 * framing.margin;
                    CHECK(std::max(x_reach, y_reach) == Approx(allowed).epsilon(0.02));
                }
            }
        }
    }
}

TEST_CASE("azimuth 0 looks from +z, azimuth 90 from +x, elevation 90 from above") {
    const Box box{{-1, -1, -1}, {1, 1, 1}};
    const auto direction = [&](double azimuth, double elevation) {
        Framing framing;
        framing.azimuth_degrees = azimuth;
        framing.elevation_degrees = elevation;
        const Camera camera = frame_camera(box, framing, 64, 64);
        return glm::normalize(camera.eye - camera.target);
    };
    CHECK(glm::distance(direction(0, 0), glm::dvec3(0, 0, 1)) < 1e-12);
    CHECK(glm::distance(direction(90, 0), glm::dvec3(1, 0, 0)) < 1e-12);
    CHECK(glm::distance(direction(17, 90), glm::dvec3(0, 1, 0)) < 1e-12);
}

TEST_CASE("an empty or single-point box still gives a camera") {
    for (const Box& box : {Box{}, Box{{1, 2, 3}, {1, 2, 3}}}) {
        const Camera camera = frame_camera(box, {}, 64, 64);
        CHECK(camera.near_plane > 0);
        CHECK(camera.far_plane > camera.near_plane);
        CHECK(glm::length(camera.target - camera.eye) > 0);
    }
}

TEST_CASE("the projection matrix agrees with project(), depth is reversed") {
    Camera camera;
    camera.eye = {1, 2, 3};
    camera.target = {-1, 0.5, -2};
    camera.near_plane = 0.25;
    camera.far_plane = 40;
    for (const bool orthographic : {false, true}) {
        camera.orthographic = orthographic;
        const glm::dmat4 matrix = projection_matrix(camera, 200, 100) * view_matrix(camera);
        for (const glm::dvec3& point : {glm::dvec3(0, 0, 0), glm::dvec3(-1.5, 1, -2), glm::dvec3(0.3, 0.8, 1)}) {
            const glm::dvec4 clip = matrix * glm::dvec4(point, 1);
            const glm::dvec3 window = project(camera, 200, 100, point);
            CHECK((clip.x / clip.w + 1) / 2 * 200 == Approx(window.x));
            CHECK((clip.y / clip.w + 1) / 2 * 100 == Approx(window.y));
            const double expected = orthographic ? (40 - window.z) / (40 - 0.25) : 0.25 / window.z;
            CHECK(clip.z / clip.w == Approx(expected));
        }
    }
}

TEST_CASE("a camera without a view is refused") {
    Camera camera;
    camera.eye = camera.target = {1, 1, 1};
    CHECK_THROWS_AS(view_matrix(camera), UsageError);
    camera.eye = {1, 5, 1};
    CHECK_THROWS_AS(view_matrix(camera), UsageError);
}
