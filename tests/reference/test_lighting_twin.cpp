// The engine's shader and the oracle's twin of it light the same points the same way.
#include "preprocess/mesh/shapes.h"
#include "tests/reference/comparison.h"
#include "tests/reference/lighting_twin.h"
#include "tests/support/test_files.h"

#include <catch2/catch.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include <algorithm>
#include <cstdlib>

using namespace splice;
using namespace splice::reference;

namespace {

IndexedMesh repaired(SourceMesh source) {
    RepairReport report;
    return repair_mesh(std::move(source), RepairOptions{}, report, "shape");
}

Lighting every_kind_of_light() {
    Lighting lighting;
    lighting.ambient = {0.05, 0.06, 0.08};
    lighting.specular = 0.3;
    lighting.shininess = 20;
    Light camera, world, point;
    camera.space = LightSpace::kCamera;
    camera.direction = {0.5, -0.7, -1};
    camera.colour = {0.5, 0.1, 0.1};
    world.direction = {-1, -0.3, 0.4};
    world.colour = {0.1, 0.5, 0.1};
    point.kind = LightKind::kPoint;
    point.position = {0.4, 2.5, 1};
    point.range = 1.5;
    point.colour = {0.2, 0.3, 0.9};
    lighting.lights = {camera, world, point};
    return lighting;
}

/// Largest difference of a channel over pixels whose 3x3 neighbourhood is covered: one sample a pixel on both sides.
int worst_difference(const IndexedMesh& mesh, const Lighting& lighting, const glm::dvec3& direction,
                     bool orthographic) {
    Renderer renderer{RendererOptions{}};
    const BakedModel baked = bake_for(renderer, mesh, {}, ForcedRepresentation::kTriangles);
    const bool two_sided = (baked.model.info.flags & format::kTwoSided) != 0;
    Scene scene = scene_of(baked.on_device);
    scene.lighting = lighting;
    CaptureSettings settings;
    settings.width = settings.height = 160;
    settings.camera = camera_from(scene.bounds(), direction, settings.width, settings.height, orthographic);
    const ColourImage image = colours(renderer.render(scene, settings));

    const ReferenceScene oracle(mesh);
    const ReferenceView view = reference_view(mesh, settings.camera, settings.width, settings.height);
    const ColourImage truth =
        oracle.shaded(view, lighting_twin(lighting, mesh, settings.camera, two_sided), glm::vec3(1), 1);
    const Mask inside = eroded(covered(oracle.depth(view)), 1.5);
    REQUIRE(std::count(inside.pixels.begin(), inside.pixels.end(), 1) > 4000);
    int worst = 0;
    for (std::size_t i = 0; i < inside.pixels.size(); ++i) {
        if (!inside.pixels[i]) continue;
        const Rgb8 a = image.pixels[i], b = truth.pixels[i];
        worst = std::max({worst, std::abs(a.r - b.r), std::abs(a.g - b.g), std::abs(a.b - b.b)});
    }
    if (worst > 3) {
        write_png(test::artefact("lighting-frame.png"), image);
        write_png(test::artefact("lighting-twin.png"), truth);
    }
    return worst;
}

}  // namespace

TEST_CASE("default lights: shader and twin agree on a coloured sphere") {
    const IndexedMesh mesh = repaired(shapes::bumpy_sphere(20000));
    CHECK(worst_difference(mesh, default_lighting(), {0.5, 0.4, 0.8}, false) <= 3);
}

TEST_CASE("every kind of light and highlights: shader and twin agree") {
    const IndexedMesh mesh = repaired(shapes::bumpy_sphere(20000));
    CHECK(worst_difference(mesh, every_kind_of_light(), {-0.3, 0.5, 0.8}, false) <= 3);
    CHECK(worst_difference(mesh, every_kind_of_light(), {-0.3, 0.5, 0.8}, true) <= 3);
}

TEST_CASE("mirrored highlights and a rim: shader and twin agree") {
    const IndexedMesh mesh = repaired(shapes::bumpy_sphere(20000));
    Lighting lighting = every_kind_of_light();
    lighting.highlight = HighlightModel::kPhong;
    lighting.shininess = 8;
    lighting.rim = 0.4;
    lighting.rim_exponent = 2;
    CHECK(worst_difference(mesh, lighting, {-0.3, 0.5, 0.8}, false) <= 3);
    CHECK(worst_difference(mesh, lighting, {-0.3, 0.5, 0.8}, true) <= 3);
}

TEST_CASE("an open surface is lit on the side that is looked at") {
    IndexedMesh sheet = repaired(shapes::checkerboard(1, 4));
    REQUIRE_FALSE(sheet.closed);
    sheet.materials[0].image = kNoImage;
    for (const double side : {1.0, -1.0})
        CHECK(worst_difference(sheet, every_kind_of_light(), glm::normalize(glm::dvec3(0.3, 0.2, side)), false) <= 3);
}

TEST_CASE("the oracle's camera is the one that textbooks derive from eye, target and field of view") {
    const IndexedMesh mesh = repaired(shapes::cube(2));
    Camera camera;
    camera.eye = {1, 2, 5};
    camera.target = {0.2, 0, 0};
    camera.fov_y_degrees = 35;
    const ReferenceView view = reference_view(mesh, camera, 640, 360);
    const glm::dmat4 look = glm::lookAt(camera.eye, camera.target, camera.up);
    glm::dmat4 projection = glm::perspective(glm::radians(35.0), 640.0 / 360.0, 0.1, 100.0);
    projection[1][1] *= -1;
    for (const glm::dvec3& corner : {glm::dvec3(0.5, 0.5, 0.5), glm::dvec3(-0.5, 0.5, -0.5)}) {
        // Cube coordinates are unit-box coordinates: edge length 1 around the origin.
        const glm::dvec4 ours = view.projection * (view.view * glm::dvec4(corner, 1));
        const glm::dvec4 theirs = projection * (look * glm::dvec4(corner, 1));
        CHECK(ours.x / ours.w == Approx(theirs.x / theirs.w));
        CHECK(ours.y / ours.w == Approx(theirs.y / theirs.w));
        CHECK(ours.w == Approx(theirs.w));
    }
}
