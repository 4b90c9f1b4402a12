// Whole frames of small handmade models: who owns which pixel, which side is seen, what blends and what does not.
#include "engine/capture/capture.h"
#include "tests/engine/handmade_model.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

using namespace splice;
using namespace splice::test;

namespace {

constexpr std::uint32_t kSize = 128;

Camera facing_the_origin(double distance = 3) {
    Camera camera;
    camera.eye = {0, 0, distance};
    camera.target = {0, 0, 0};
    camera.fov_y_degrees = 40;
    return camera;
}

CaptureSettings small_picture(const Camera& camera = facing_the_origin()) {
    CaptureSettings settings;
    settings.width = settings.height = kSize;
    settings.camera = camera;
    settings.want_depth = true;
    return settings;
}

Scene scene_with(Renderer& renderer, HandmadeModel& model, bool lit = false) {
    Scene scene = scene_of(renderer.load(view_of(model.model())));
    scene.background.colour = glm::dvec3(0);
    if (!lit) {
        scene.lighting.ambient = glm::dvec3(1);
        scene.lighting.lights.clear();
    }
    return scene;
}

struct Pixel {
    int red, green, blue, alpha;
    bool operator==(const Pixel&) const = default;
};

Pixel pixel_at(const Frame& frame, std::uint32_t x, std::uint32_t y) {
    const std::uint8_t* p = &frame.rgba[4 * (std::size_t{y} * frame.width + x)];
    return {p[0], p[1], p[2], p[3]};
}

float depth_at(const Frame& frame, std::uint32_t x, std::uint32_t y) {
    return frame.depth[std::size_t{y} * frame.width + x];
}

std::size_t count_pixels(const Frame& frame, const auto& predicate) {
    std::size_t count = 0;
    for (std::uint32_t y = 0; y < frame.height; ++y)
        for (std::uint32_t x = 0; x < frame.width; ++x)
            if (predicate(x, y)) ++count;
    return count;
}

// A ball of disks, as rough as a baked one.
std::vector<Disk> ball(int count, float radius, std::uint32_t colour = 0xffffffff) {
    std::vector<Disk> disks;
    const double golden = std::numbers::pi * (3 - std::sqrt(5.0));
    const double spacing = radius * std::sqrt(4 * std::numbers::pi / count);
    for (int i = 0; i < count; ++i) {
        const double z = 1 - (2 * i + 1.0) / count, r = std::sqrt(1 - z * z);
        const glm::vec3 n(static_cast<float>(r * std::cos(golden * i)), static_cast<float>(r * std::sin(golden * i)),
                          static_cast<float>(z));
        disks.push_back({n * radius, n, static_cast<float>(spacing), static_cast<float>(spacing), colour});
    }
    return disks;
}

}  // namespace

TEST_CASE("point sprites and quads make the same picture") {
    Renderer renderer({});
    HandmadeModel model;
    model.add_surfels(ball(3000, 0.8f, kBlue)).add_surfels(ball(40, 0.6f, kRed));
    const Scene scene = scene_with(renderer, model, true);
    for (const bool orthographic : {false, true}) {
        CAPTURE(orthographic);
        CaptureSettings settings = small_picture();
        settings.camera.orthographic = orthographic;
        const Frame sprites = renderer.render(scene, settings);
        settings.force_quads = true;
        const Frame quads = renderer.render(scene, settings);
        CHECK(sprites.coverage == quads.coverage);
        int largest = 0;
        for (std::size_t i = 0; i < sprites.rgba.size(); ++i)
            largest = std::max(largest, std::abs(sprites.rgba[i] - quads.rgba[i]));
        CHECK(largest <= 1);  // sums in another order
        CHECK(sprites.stats.covered_pixels > 3000);
    }
}

TEST_CASE("the same frame has the same bytes each time") {
    Renderer renderer({});
    HandmadeModel model;
    model.add_surfels(ball(3000, 0.8f)).add_triangles(quad({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}, kGreen));
    const Scene scene = scene_with(renderer, model, true);
    const Frame first = renderer.render(scene, small_picture());
    CaptureSettings other = small_picture();
    other.width = 96;
    other.view = View::kOverlap;
    renderer.render(scene, other);
    const Frame second = renderer.render(scene, small_picture());
    Renderer fresh({});
    const Frame third = fresh.render(scene_with(fresh, model, true), small_picture());
    CHECK(first.rgba == second.rgba);
    CHECK(first.depth == second.depth);
    CHECK(first.rgba == third.rgba);
    CHECK(first.depth == third.depth);
}

TEST_CASE("a triangle patch owns the pixels that it shares with coplanar surfels") {
    Renderer renderer({});
    // Left half triangles; the surfels of the right half reach over the border.
    HandmadeModel model;
    model.add_triangles(quad({-0.8f, -0.8f, 0}, {0.8f, 0, 0}, {0, 1.6f, 0}, kRed));
    model.add_surfels(sheet({0, -0.8f, 0}, {0.8f, 0, 0}, {0, 1.6f, 0}, 16, kGreen));
    for (const bool orthographic : {false, true}) {
        for (const double azimuth : {0.0, 50.0, 80.0}) {
            CAPTURE(orthographic, azimuth);
            Camera camera = facing_the_origin();
            camera.orthographic = orthographic;
            const double angle = glm::radians(azimuth);
            camera.eye = 3.0 * glm::dvec3(std::sin(angle), 0.1, std::cos(angle));
            const CaptureSettings settings = small_picture(camera);
            const Frame both = renderer.render(scene_with(renderer, model), settings);
            CaptureSettings alone = settings;
            alone.draw_surfels = false;
            const Frame triangles = renderer.render(scene_with(renderer, model), alone);
            const std::size_t stolen = count_pixels(both, [&](std::uint32_t x, std::uint32_t y) {
                return triangles.coverage[y * kSize + x] != 0 && pixel_at(both, x, y) != Pixel{255, 0, 0, 255};
            });
            CHECK(triangles.stats.covered_pixels > 100);
            CHECK(both.stats.covered_pixels > triangles.stats.covered_pixels + 100);
            CHECK(stolen == 0);
            // And no gap between the two: rows through the middle are covered without a break.
            const std::uint32_t y = kSize / 2;
            std::vector<std::uint32_t> covered;
            for (std::uint32_t x = 0; x < kSize; ++x)
                if (both.coverage[y * kSize + x] != 0) covered.push_back(x);
            REQUIRE_FALSE(covered.empty());
            CHECK(covered.back() - covered.front() + 1 == covered.size());
        }
    }
}

TEST_CASE("two sheets two epsilon apart do not bleed into each other") {
    Renderer renderer({});
    const int count = 24;
    const float spacing = 1.6f / count;
    for (const bool front_is_red : {true, false}) {
        for (const double azimuth : {0.0, 30.0}) {
            CAPTURE(front_is_red, azimuth);
            HandmadeModel model;
            model.add_surfels(
                sheet({-0.8f, -0.8f, front_is_red ? 0 : -2 * spacing}, {1.6f, 0, 0}, {0, 1.6f, 0}, count, kRed));
            model.add_surfels(
                sheet({-0.8f, -0.8f, front_is_red ? -2 * spacing : 0}, {1.6f, 0, 0}, {0, 1.6f, 0}, count, kGreen));
            Camera camera = facing_the_origin();
            const double angle = glm::radians(azimuth);
            camera.eye = 3.0 * glm::dvec3(std::sin(angle), 0, std::cos(angle));
            const Frame frame = renderer.render(scene_with(renderer, model), small_picture(camera));
            const Pixel front = front_is_red ? Pixel{255, 0, 0, 255} : Pixel{0, 255, 0, 255};
            std::size_t inner = 0;
            const std::size_t wrong = count_pixels(frame, [&](std::uint32_t x, std::uint32_t y) {
                const bool inside = x > 45 && x < 83 && y > 40 && y < 88;
                inner += inside ? 1 : 0;
                return inside && pixel_at(frame, x, y) != front;
            });
            CHECK(inner > 1000);
            CHECK(wrong == 0);
        }
    }
}

TEST_CASE("sheets closer than epsilon blend, which a smaller epsilon scale undoes") {
    Renderer renderer({});
    HandmadeModel model;
    const float spacing = 0.1f;
    model.add_surfels(sheet({-0.8f, -0.8f, 0}, {1.6f, 0, 0}, {0, 1.6f, 0}, 16, kRed));
    model.add_surfels(sheet({-0.8f, -0.8f, -0.5f * spacing}, {1.6f, 0, 0}, {0, 1.6f, 0}, 16, kGreen));
    CaptureSettings settings = small_picture();
    CHECK(pixel_at(renderer.render(scene_with(renderer, model), settings), 64, 64).green > 50);
    settings.epsilon_scale = 0.4;
    CHECK(pixel_at(renderer.render(scene_with(renderer, model), settings), 64, 64) == Pixel{255, 0, 0, 255});
}

TEST_CASE("depth is the surface's, without epsilon, wherever surfels or triangles own the pixel") {
    Renderer renderer({});
    HandmadeModel model;
    model.add_surfels(sheet({0, -0.8f, 0.25f}, {0.8f, 0, 0}, {0, 1.6f, 0}, 16));
    model.add_triangles(quad({-0.8f, -0.8f, 0.25f}, {0.6f, 0, 0}, {0, 1.6f, 0}));
    for (const bool orthographic : {false, true}) {
        CAPTURE(orthographic);
        CaptureSettings settings = small_picture();
        settings.camera.orthographic = orthographic;
        const Frame frame = renderer.render(scene_with(renderer, model), settings);
        CHECK(depth_at(frame, 80, 64) == Approx(2.75).epsilon(1e-4));
        CHECK(depth_at(frame, 40, 64) == Approx(2.75).epsilon(1e-4));
        CHECK(std::isinf(depth_at(frame, 2, 2)));
        CHECK(std::isinf(depth_at(frame, 126, 2)));
    }
}

TEST_CASE("where the visibility pass wrote there is a weight") {
    Renderer renderer({});
    HandmadeModel model(true);
    // Radii from far below a pixel to a fifth of the picture, turned every way.
    std::vector<Disk> disks = ball(500, 0.9f);
    for (std::size_t i = 0; i < disks.size(); ++i) {
        disks[i].radius = 0.0005f * std::pow(1.015f, static_cast<float>(i));
        disks[i].epsilon = disks[i].radius;
        disks[i].normal = glm::vec3(disks[i].normal.y, disks[(i * 7) % 500].normal.x, disks[i].normal.z);
    }
    model.add_surfels(disks);
    for (const bool prefilter : {true, false}) {
        for (const double distance : {0.2, 1.0, 3.0, 40.0}) {
            for (const bool orthographic : {false, true}) {
                CAPTURE(prefilter, distance, orthographic);
                CaptureSettings settings = small_picture(facing_the_origin(distance));
                settings.prefilter = prefilter;
                settings.camera.orthographic = orthographic;
                const Frame frame = renderer.render(scene_with(renderer, model), settings);
                CHECK(frame.stats.covered_pixels > 0);
                // 0 / 0 would be the depth of a pixel that surfels own without a weight.
                CHECK(std::none_of(frame.depth.begin(), frame.depth.end(), [](float d) { return std::isnan(d); }));
                std::size_t differ = 0;
                for (std::size_t i = 0; i < frame.depth.size(); ++i)
                    if (std::isinf(frame.depth[i]) != (frame.coverage[i] == 0)) ++differ;
                CHECK(differ == 0);
            }
        }
    }
}

TEST_CASE("one-sided surfaces vanish from behind, two-sided ones are lit there") {
    Renderer renderer({});
    for (const bool two_sided : {false, true}) {
        HandmadeModel model(two_sided);
        model.add_surfels(sheet({-0.8f, -0.8f, 0}, {0.7f, 0, 0}, {0, 1.6f, 0}, 16));
        model.add_triangles(quad({0.1f, -0.8f, 0}, {0.7f, 0, 0}, {0, 1.6f, 0}));
        const Scene scene = scene_with(renderer, model, true);
        CaptureSettings settings = small_picture();
        const Frame front = renderer.render(scene, settings);
        settings.camera.eye = {0, 0, -3};
        const Frame back = renderer.render(scene, settings);
        settings.sides = two_sided ? Sides::kOneSided : Sides::kTwoSided;
        const Frame overridden = renderer.render(scene, settings);
        CAPTURE(two_sided);
        CHECK(front.stats.covered_pixels > 3000);
        const Frame& visible = two_sided ? back : overridden;
        const Frame& hidden = two_sided ? overridden : back;
        CHECK(hidden.stats.covered_pixels == 0);
        CHECK(visible.stats.covered_pixels == Approx(front.stats.covered_pixels).epsilon(0.02));
        // The light moves with the camera, so the two sides look alike: left and right have changed places.
        for (const std::uint32_t x : {40u, 88u}) {
            CHECK(std::abs(pixel_at(visible, x, 64).red - pixel_at(front, x, 64).red) <= 2);
            CHECK(pixel_at(visible, x, 64).red > 150);
        }
    }
}

TEST_CASE("a transparent background makes alpha the coverage") {
    Renderer renderer({});
    HandmadeModel model;
    model.add_surfels(ball(2000, 0.6f, kRed));
    Scene scene = scene_with(renderer, model);
    scene.background.transparent = true;
    const Frame frame = renderer.render(scene, small_picture());
    CHECK(pixel_at(frame, 64, 64) == Pixel{255, 0, 0, 255});
    CHECK(pixel_at(frame, 3, 3) == Pixel{0, 0, 0, 0});
    scene.background.transparent = false;
    scene.background.colour = {1, 0.5, 0};
    const Frame opaque = renderer.render(scene, small_picture());
    CHECK(pixel_at(opaque, 3, 3) == Pixel{255, 128, 0, 255});
    CHECK(opaque.coverage == frame.coverage);
}

TEST_CASE("textures show on triangle patches, repeated, row 0 at the top") {
    Renderer renderer({});
    HandmadeModel model;
    const std::uint32_t material = model.add_texture(2, 2, {kRed, kGreen, kBlue, 0xffffffff});
    std::vector<Corner> corners = quad({-0.9f, -0.9f, 0}, {1.8f, 0, 0}, {0, 1.8f, 0});
    for (Corner& corner : corners)
        corner.uv *= 2.0f;
    model.add_triangles(corners, material);
    const Frame frame = renderer.render(scene_with(renderer, model), small_picture());
    // Two repetitions: texel centres lie at 1/8, 3/8, 5/8, 7/8 of the square, which spans pixels 11 to 117.
    const auto at = [&](int column, int row) {
        return pixel_at(frame, static_cast<std::uint32_t>(11 + 106 * (2 * column + 1) / 8),
                        static_cast<std::uint32_t>(11 + 106 * (2 * row + 1) / 8));
    };
    for (const int shift : {0, 2}) {
        CHECK(at(shift, 0).red > 220);
        CHECK(at(shift, 0).green < 120);
        CHECK(at(shift + 1, shift).green > 220);
        CHECK(at(shift, shift + 1).blue > 220);
        CHECK(std::min({at(shift + 1, 1).red, at(shift + 1, 1).green, at(shift + 1, 1).blue}) > 200);
    }
}

TEST_CASE("instances are placed by scale, rotation and translation, and epsilon scales with them") {
    Renderer renderer({});
    HandmadeModel model;
    model.add_surfels(sheet({-0.5f, -0.5f, 0}, {1, 0, 0}, {0, 1, 0}, 12, kRed));
    const auto on_device = renderer.load(view_of(model.model()));
    Scene scene = scene_with(renderer, model);
    Instance turned{on_device, {}};
    turned.transform.scale = 0.5;
    turned.transform.rotation = glm::dmat3(glm::dvec3(0, 0, -1), glm::dvec3(0, 1, 0), glm::dvec3(1, 0, 0));
    turned.transform.translation = {0.9, 0, 0};
    scene.instances = {{on_device, {0.5, glm::dmat3(1.0), {-0.5, 0.5, 0.25}}}, turned};
    const Box bounds = scene.bounds();
    CHECK(bounds.maximum.x == Approx(0.9).margin(0.2));
    CHECK(bounds.minimum.x < -0.7);
    const Frame frame = renderer.render(scene, small_picture());
    // 40 degrees, 128 px, 3 away: 58.6 px a unit at depth 3.
    CHECK(depth_at(frame, 64 - 32, 64 - 32) == Approx(2.75).epsilon(1e-4));
    CHECK(std::isinf(depth_at(frame, 64 - 32, 64 + 32)));
    CHECK(frame.stats.surfels_drawn == 2 * 13 * 13);

    // The second sheet stands edge-on to this camera; from its front it is half as large as the model says.
    CaptureSettings side = small_picture();
    side.camera.eye = {3.9, 0, 0};
    side.camera.target = {0.9, 0, 0};
    const Frame from_side = renderer.render(scene, side);
    CHECK(depth_at(from_side, 64, 64) == Approx(3.0).epsilon(1e-3));
    const double expected = std::pow(0.5 * 58.6, 2);
    CHECK(from_side.stats.covered_pixels == Approx(expected).epsilon(0.45));
}

TEST_CASE("models far from the origin keep their shape") {
    Renderer renderer({});
    HandmadeModel model;
    model.add_surfels(ball(2000, 0.6f, kRed));
    Scene scene = scene_with(renderer, model);
    const Frame near_origin = renderer.render(scene, small_picture());
    const glm::dvec3 far_away(4.1e6, -2.5e6, 7.7e5);
    scene.instances[0].transform.translation = far_away;
    CaptureSettings settings = small_picture();
    settings.camera.eye += far_away;
    settings.camera.target += far_away;
    const Frame moved = renderer.render(scene, settings);
    const std::size_t differ = count_pixels(moved, [&](std::uint32_t x, std::uint32_t y) {
        return moved.coverage[y * kSize + x] != near_origin.coverage[y * kSize + x];
    });
    CHECK(differ <= 8);  // the eye's position itself is rounded to 1e-9
}

TEST_CASE("every view is drawn and the validation layers have nothing to say") {
    Renderer renderer({.device = "auto", .validate = true});
    HandmadeModel model(true);
    model.add_surfels(ball(1500, 0.5f));
    model.add_surfels({{{2.5f, 0, -1}, {0, 0.2f, 1}, 2.2f, 0.1f, kBlue}});  // a quad
    const std::uint32_t material = model.add_texture(1, 1, {kGreen});
    model.add_triangles(quad({-1, -1, -0.2f}, {1, 0, 0}, {0, 2, 0}), material);
    const Scene scene = scene_with(renderer, model, true);
    std::vector<std::vector<std::uint8_t>> pictures;
    for (const Named<View>& known : kViewNames) {
        CAPTURE(known.name);
        CaptureSettings settings = small_picture();
        settings.view = known.value;
        settings.want_overlap = true;
        const Frame frame = renderer.render(scene, settings);
        CHECK(frame.stats.covered_pixels > 500);
        CHECK(frame.stats.passes.size() == (known.value == View::kBoxes ? 6 : 5));
        pictures.push_back(frame.rgba);
    }
    std::sort(pictures.begin(), pictures.end());
    CHECK(std::adjacent_find(pictures.begin(), pictures.end()) == pictures.end());
    CHECK(renderer.validation_messages() == std::vector<std::string>{});
}

TEST_CASE("overlap counts surfels, and only contributing ones") {
    Renderer renderer({});
    HandmadeModel model;
    const Disk disk{{0, 0, 0}, {0, 0, 1}, 0.5f, 0.1f};
    model.add_surfels({disk, disk, disk, {{0, 0, -1}, {0, 0, 1}, 0.5f, 0.1f}});
    CaptureSettings settings = small_picture();
    settings.want_overlap = true;
    settings.merge_px = 0;  // disks in one place would be one
    const Frame frame = renderer.render(scene_with(renderer, model), settings);
    CHECK(frame.stats.overlap_mean == Approx(3));
    CHECK(frame.stats.surfels_drawn == 4);
}

TEST_CASE("an empty scene is a background") {
    Renderer renderer({});
    Scene scene;
    scene.background.colour = glm::dvec3(0, 0, 1);
    for (const Named<View>& known : kViewNames) {
        CaptureSettings settings = small_picture();
        settings.view = known.value;
        const Frame frame = renderer.render(scene, settings);
        CHECK(frame.stats.covered_pixels == 0);
        CHECK(pixel_at(frame, 10, 10) == Pixel{0, 0, 255, 255});
    }
}
