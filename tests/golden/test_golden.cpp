// Every view of a handmade model, which no change of the bake touches, and every scene of scenes/, baked on the way.
#include "engine/capture/camera_path.h"
#include "engine/capture/capture.h"
#include "engine/capture/load_scene.h"
#include "tests/engine/handmade_model.h"
#include "tests/golden/golden.h"
#include "tests/support/test_files.h"

#include <catch2/catch.hpp>

#include <cmath>
#include <numbers>

using namespace splice;
using namespace splice::test;

namespace {

constexpr const char* kClean = "";

// A bumpy ball of disks, coloured by direction, on a slab of triangles.
HandmadeModel showcase() {
    HandmadeModel model(true);
    constexpr int kCount = 1400, kPatches = 7;
    const double golden_angle = std::numbers::pi * (3 - std::sqrt(5.0));
    const auto spacing = static_cast<float>(0.55 * std::sqrt(4 * std::numbers::pi / kCount));
    std::vector<std::vector<Disk>> patches(kPatches);
    for (int i = 0; i < kCount; ++i) {
        const double z = 1 - (2 * i + 1.0) / kCount, r = std::sqrt(1 - z * z);
        const glm::vec3 n(static_cast<float>(r * std::cos(golden_angle * i)), static_cast<float>(z),
                          static_cast<float>(r * std::sin(golden_angle * i)));
        const auto level = [](float v) { return static_cast<std::uint32_t>(std::lround(160 + 95 * v)); };
        const std::uint32_t colour = 0xff000000u | level(n.x) | level(n.y) << 8 | level(n.z) << 16;
        const float radius = 0.55f + 0.03f * std::sin(9 * n.x) * std::sin(8 * n.y);
        patches[static_cast<std::size_t>(i * kPatches / kCount)].push_back(
            {n * radius, n, 1.1f * spacing, spacing, colour});
    }
    for (const auto& patch : patches)
        model.add_surfels(patch);
    const std::uint32_t checks = model.add_texture(2, 2, {0xff303030, 0xffd0d0d0, 0xffd0d0d0, 0xff303030});
    for (int row = 0; row < 2; ++row) {
        for (int column = 0; column < 2; ++column) {
            auto corners =
                quad({-0.9f + 0.9f * static_cast<float>(column), -0.45f, 0.9f - 0.9f * static_cast<float>(row)},
                     {0.9f, 0, 0}, {0, 0, -0.9f});
            for (Corner& corner : corners)
                corner.uv *= 3.0f;
            model.add_triangles(corners, checks);
        }
    }
    return model;
}

}  // namespace

TEST_CASE("each view looks as it did") {
    Renderer renderer({});
    HandmadeModel model = showcase();
    const Scene scene = scene_of(renderer.load(view_of(model.model())));
    CaptureSettings settings;
    settings.width = settings.height = 160;
    settings.camera = frame_camera(scene.bounds(), {}, settings.width, settings.height);
    for (const Named<View>& known : kViewNames) {
        settings.view = known.value;
        Frame frame = renderer.render(scene, settings);
        CHECK(compare_with_golden("view-" + std::string(known.name),
                                  {frame.width, frame.height, std::move(frame.rgba)}) == kClean);
    }
    settings.view = View::kShaded;
    settings.camera.orthographic = true;
    settings.camera.orthographic_height = 2;
    Frame frame = renderer.render(scene, settings);
    CHECK(compare_with_golden("orthographic", {frame.width, frame.height, std::move(frame.rgba)}) == kClean);
}

TEST_CASE("each scene looks as it did") {
    Renderer renderer({});
    for (const char* name : {"bumpy_sphere", "checkerboard", "checkerboard_surfels", "gallery", "machined_part",
                             "terrain", "torus_knot"}) {
        const LoadedScene loaded = load_scene(source_file(std::string("scenes/") + name + ".json"), renderer);
        CaptureCommand command;
        command.size = {192, 192};
        CaptureSettings settings;
        settings.width = settings.height = 192;
        settings.camera = camera_path(command, loaded.description, loaded.scene.bounds()).front();
        Frame frame = renderer.render(loaded.scene, settings);
        // Another spacing or another choice of patches moves shades by a little, and silhouettes by a pixel.
        CHECK(compare_with_golden(std::string("scene-") + name, {frame.width, frame.height, std::move(frame.rgba)},
                                  {.channel = 16, .bad_pixels = 0.02}) == kClean);
    }
}
