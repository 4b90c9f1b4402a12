// Deferred shading: normals and albedos are blended, pixels are lit.
#include "engine/capture/capture.h"
#include "preprocess/model_format/tangent_frame.h"
#include "preprocess/surfel/shading_bend.h"
#include "tests/engine/handmade_model.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>

using namespace splice;
using namespace splice::test;

namespace {

constexpr std::uint32_t kSize = 96;

CaptureSettings facing(double z, Shading shading) {
    CaptureSettings settings;
    settings.width = settings.height = kSize;
    settings.camera.eye = {0, 0, z};
    settings.camera.fov_y_degrees = 40;
    settings.shading = shading;
    return settings;
}

// Over the pixels up to `reach` from the middle.
int worst_difference(const Frame& a, const Frame& b, std::uint32_t reach = kSize / 2) {
    int worst = 0;
    for (std::uint32_t y = kSize / 2 - reach; y < kSize / 2 + reach; ++y)
        for (std::uint32_t x = kSize / 2 - reach; x < kSize / 2 + reach; ++x)
            for (std::size_t c = 0; c < 4; ++c) {
                const std::size_t i = 4 * (std::size_t{y} * kSize + x) + c;
                worst = std::max(worst, std::abs(a.rgba[i] - b.rgba[i]));
            }
    return worst;
}

Light lamp(const glm::dvec3& position, double range) {
    Light light;
    light.kind = LightKind::kPoint;
    light.position = position;
    light.range = range;
    return light;
}

}  // namespace

TEST_CASE("on a plane under parallel light both shadings agree") {
    Renderer renderer({});
    HandmadeModel model;
    model.add_surfels(sheet({-0.8f, -0.8f, 0}, {1.6f, 0, 0}, {0, 1.6f, 0.2f}, 30, kGreen))
        .add_triangles(quad({-0.5f, -0.9f, 0.1f}, {0.4f, 0, 0}, {0, 0.6f, 0}, kRed));
    const Scene scene = scene_of(renderer.load(view_of(model.model())));
    const Frame deferred = renderer.render(scene, facing(3, Shading::kDeferred));
    CHECK(worst_difference(deferred, renderer.render(scene, facing(3, Shading::kSurfel))) <= 1);
    CHECK(deferred.stats.shading == Shading::kDeferred);
    CHECK(renderer.render(scene, facing(3, Shading::kDeferred)).rgba == deferred.rgba);
}

TEST_CASE("near lamps and highlights light each pixel, however large the disks are") {
    Renderer renderer({});
    HandmadeModel surfels, triangles;
    surfels.add_surfels(sheet({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}, 5));
    triangles.add_triangles(quad({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}));
    for (const bool orthographic : {false, true}) {
        CAPTURE(orthographic);
        Scene scene = scene_of(renderer.load(view_of(surfels.model())));
        Scene truth = scene_of(renderer.load(view_of(triangles.model())));
        scene.lighting.lights = {lamp({0.2, 0.1, 0.3}, 0.4), lamp({-0.4, -0.3, 0.2}, 0.2)};
        scene.lighting.lights[1].colour = {0.9, 0.3, 0.1};
        scene.lighting.specular = 0.4;
        scene.lighting.shininess = 40;
        scene.lighting.rim = 0.2;
        truth.lighting = scene.lighting;
        CaptureSettings settings = facing(3, Shading::kDeferred);
        settings.camera.orthographic = orthographic;
        settings.camera.orthographic_height = 2;
        const Frame expected = renderer.render(truth, settings), deferred = renderer.render(scene, settings);
        CHECK(worst_difference(deferred, expected, 30) <= 2);
        settings.shading = Shading::kSurfel;
        CHECK(worst_difference(renderer.render(scene, settings), expected, 30) > 12);
    }
}

TEST_CASE("a two-sided sheet is lit from both sides in either shading") {
    Renderer renderer({});
    HandmadeModel model(true);
    model.add_surfels(sheet({-0.8f, -0.8f, 0}, {1.6f, 0, 0}, {0, 1.6f, 0}, 30, kGreen));
    const Scene scene = scene_of(renderer.load(view_of(model.model())));
    for (const double z : {3.0, -3.0}) {
        const Frame deferred = renderer.render(scene, facing(z, Shading::kDeferred));
        CHECK(worst_difference(deferred, renderer.render(scene, facing(z, Shading::kSurfel))) <= 1);
        CHECK(deferred.rgba[4 * (kSize / 2 * kSize + kSize / 2) + 1] > 150);
    }
}

// Its plane is seen from behind, but right beyond a silhouette its near end stands for what is before that.
TEST_CASE("a two-sided disk beyond a silhouette shows the side that its near end bends to") {
    Renderer renderer({});
    const glm::vec3 normal = glm::normalize(glm::vec3(0, 0.937f, -0.35f));
    HandmadeModel handmade(true);
    handmade.add_surfels({{{0, 0, 0}, normal, 0.5f, 0.01f}});
    Model model = handmade.model();
    const TangentFrame frame = tangents_of({normal.x, normal.y, normal.z});
    const glm::vec2 nearer = glm::normalize(glm::vec2(frame.s[2], frame.t[2]));
    for (const float bend : {0.5f, -0.5f}) {
        const float radius = 1;
        const std::array<std::int8_t, 5> stored = encode_shading_bend(
            {0, 0, bend * nearer.x * nearer.x, bend * nearer.x * nearer.y, bend * nearer.y * nearer.y}, radius);
        std::copy(stored.begin(), stored.end(), model.surfels[0].shading_bend);
        const Scene scene = scene_of(renderer.load(view_of(model)));
        for (const Shading shading : {Shading::kSurfel, Shading::kDeferred}) {
            CaptureSettings settings = facing(3, shading);
            settings.view = View::kNormals;
            const int up = renderer.render(scene, settings).rgba[4 * (kSize / 2 * kSize + kSize / 2) + 1];
            CAPTURE(bend, up);
            CHECK((bend > 0 ? up > 230 : up < 25));
        }
    }
}

TEST_CASE("views that show no light are the same in either shading") {
    Renderer renderer({});
    HandmadeModel model;
    model.add_surfels(sheet({-0.8f, -0.8f, 0}, {1.6f, 0, 0.3f}, {0, 1.6f, 0.2f}, 20, kGreen));
    const Scene scene = scene_of(renderer.load(view_of(model.model())));
    for (const Named<View>& known : kViewNames) {
        CAPTURE(known.name);
        CaptureSettings settings = facing(3, Shading::kDeferred);
        settings.view = known.value;
        const Frame deferred = renderer.render(scene, settings);
        settings.shading = Shading::kSurfel;
        CHECK(worst_difference(deferred, renderer.render(scene, settings)) <= 1);
    }
}

TEST_CASE("each sample of a pixel is lit when several are drawn") {
    Renderer renderer({});
    HandmadeModel model;
    model.add_surfels(sheet({-0.8f, -0.8f, 0}, {1.6f, 0, 0}, {0, 1.6f, 0.2f}, 30, kGreen));
    const Scene scene = scene_of(renderer.load(view_of(model.model())));
    CaptureSettings settings = facing(3, Shading::kDeferred);
    settings.antialias = 2;
    const Frame deferred = renderer.render(scene, settings);
    settings.shading = Shading::kSurfel;
    CHECK(worst_difference(deferred, renderer.render(scene, settings)) <= 1);
}
