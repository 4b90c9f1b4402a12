// Single splats against the double-precision oracle: which pixels they cover, at what depth, with what weight.
#include "engine/capture/capture.h"
#include "tests/engine/handmade_model.h"
#include "tests/engine/splat_oracle.h"
#include "tests/engine/test_cameras.h"

#include <catch2/catch.hpp>

#include <cmath>

using namespace splice;
using namespace splice::test;

namespace {

struct SplatCase {
    const char* name;
    Disk disk;
    Camera camera;
    std::uint32_t width = 160, height = 120;
    bool prefilter = true;
    bool shows = true;  // false: edge-on between pixel centres, where a triangle would not show either
};

glm::vec3 tilted(double degrees, double roll_degrees = 25) {
    const double tilt = glm::radians(degrees), roll = glm::radians(roll_degrees);
    return {std::sin(tilt) * std::cos(roll), std::sin(tilt) * std::sin(roll), std::cos(tilt)};
}

std::vector<SplatCase> splat_cases() {
    const Camera eye = looking_down_z();
    return {
        {"facing", {{0.1f, 0.05f, -2}, {0, 0, 1}, 0.3f, 0.01f}, eye},
        {"tilted by 60 degrees, off axis", {{0.5f, -0.4f, -2}, tilted(60), 0.4f, 0.01f}, eye},
        {"grazing, 85 degrees", {{-0.3f, 0.2f, -2}, tilted(85, 70), 0.5f, 0.01f}, eye},
        {"grazing, 89.5 degrees", {{0.02f, 0.01f, -2}, tilted(89.5, 10), 0.5f, 0.01f}, eye},
        {"seen edge-on", {{0.203f, 0, -2}, {0, 1, 0}, 0.4f, 0.01f}, eye, 160, 120, true, false},
        {"a pixel large", {{0.303f, 0.107f, -2}, tilted(30), 0.012f, 0.01f}, eye},
        {"a tenth of a pixel", {{0.317544f, -0.125093f, -2}, tilted(40), 0.001f, 0.001f}, eye},
        {"between pixel centres", {{0.31f, -0.12f, -2}, tilted(40), 0.001f, 0.001f}, eye},
        {"between pixel centres without prefilter",
         {{0.31f, -0.12f, -2}, tilted(40), 0.001f, 0.001f},
         eye,
         160,
         120,
         false},
        {"between pixel centres, parallel rays", {{0.303f, 0.104f, -2}, tilted(30), 0.002f, 0.001f}, parallel(eye)},
        {"a tenth of a pixel without prefilter",
         {{0.317544f, -0.125093f, -2}, tilted(40), 0.001f, 0.001f},
         eye,
         160,
         120,
         false},
        {"without prefilter", {{0.1f, 0.05f, -2}, tilted(50), 0.3f, 0.01f}, eye, 160, 120, false},
        {"large and near, strong perspective", {{0.2f, -0.1f, -0.8f}, tilted(65), 0.5f, 0.01f}, eye},
        {"crossing the near plane", {{0.05f, -0.2f, -0.3f}, tilted(80, 90), 0.6f, 0.01f}, looking_down_z(0.1)},
        {"crossing, centre behind the eye", {{0.1f, -0.3f, 0.2f}, {0, 1, 0.1f}, 2, 0.01f}, looking_down_z(0.1)},
        {"floor under the eye", {{0, -0.4f, 0}, {0, 1, 0}, 5, 0.01f}, looking_down_z(0.1)},
        {"centre off the screen", {{2.2f, 0.3f, -2}, tilted(20), 1, 0.01f}, eye},
        {"centre far off the screen", {{6, 0, -2}, tilted(15), 6.5f, 0.01f}, eye},
        {"wider than 255 pixels", {{0.1f, 0, -2}, tilted(35), 1.6f, 0.01f}, eye, 480, 360},
        {"parallel rays, facing", {{0.2f, 0.1f, -2}, {0, 0, 1}, 0.3f, 0.01f}, parallel(eye)},
        {"parallel rays, grazing", {{-0.3f, 0.1f, -2}, tilted(84, 40), 0.5f, 0.01f}, parallel(eye)},
        {"parallel rays, edge-on",
         {{0.007f, 0.103f, -2}, {1, 0, 0}, 0.3f, 0.01f},
         parallel(eye),
         160,
         120,
         true,
         false},
        {"parallel rays, crossing the near plane",
         {{0.1f, 0, -0.3f}, tilted(70), 0.8f, 0.01f},
         parallel(looking_down_z(0.1))},
        {"parallel rays, sub-pixel", {{0.308333f, 0.108333f, -2}, tilted(30), 0.002f, 0.001f}, parallel(eye)},
        {"parallel rays, centre off the screen", {{1.6f, 0.3f, -2}, tilted(20), 0.6f, 0.01f}, parallel(eye)},
    };
}

CaptureSettings settings_of(const SplatCase& splat) {
    CaptureSettings settings;
    settings.width = splat.width;
    settings.height = splat.height;
    settings.camera = splat.camera;
    settings.clip_to_scene = false;
    settings.prefilter = splat.prefilter;
    settings.want_depth = true;
    return settings;
}

Scene unlit(Renderer& renderer, HandmadeModel& model) {
    Scene scene = scene_of(renderer.load(view_of(model.model())));
    scene.lighting.ambient = glm::dvec3(1);
    scene.lighting.lights.clear();
    return scene;
}

double linear(std::uint8_t encoded) {
    const double c = encoded / 255.0;
    return c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
}

// Single precision decides otherwise only where the truth is as close as this.
constexpr double kUndecided = 3e-3;

}  // namespace

TEST_CASE("a splat covers the pixels and has the depths of the ray-plane intersection") {
    Renderer renderer({});
    for (const SplatCase& splat : splat_cases()) {
        for (const bool quads : {false, true}) {
            CAPTURE(splat.name, quads);
            HandmadeModel model(true);
            model.add_surfels({splat.disk});
            CaptureSettings settings = settings_of(splat);
            settings.force_quads = quads;
            const Frame frame = renderer.render(unlit(renderer, model), settings);
            const SplatOracle oracle(splat.disk, splat.camera, splat.width, splat.height, splat.prefilter);
            int covered = 0, wrong_cover = 0, wrong_depth = 0;
            for (std::uint32_t y = 0; y < splat.height; ++y) {
                for (std::uint32_t x = 0; x < splat.width; ++x) {
                    const SplatPixel truth = oracle.at(x, y);
                    const std::size_t i = std::size_t{y} * splat.width + x;
                    const bool shown = truth.on_disk || truth.between;
                    covered += shown ? 1 : 0;
                    if (truth.certainty < kUndecided) continue;
                    if ((frame.coverage[i] != 0) != shown) ++wrong_cover;
                    if (shown && frame.coverage[i] != 0 &&
                        std::abs(static_cast<double>(frame.depth[i]) / truth.depth - 1) > 1e-3)
                        ++wrong_depth;
                }
            }
            CHECK((covered > 0) == splat.shows);
            CHECK(wrong_cover == 0);
            CHECK(wrong_depth == 0);
        }
    }
}

TEST_CASE("overlapping splats blend by their EWA weights") {
    Renderer renderer({});
    for (const SplatCase& splat : splat_cases()) {
        for (const bool quads : {false, true}) {
            CAPTURE(splat.name, quads);
            Disk front = splat.disk;
            front.colour = kRed;
            front.epsilon = 0.5f;  // times the scale below: everything blends
            // Behind it a disk that covers the screen: the rim of the front one's footprint shows on it.
            const Disk back{{0, 0, -6}, {0, 0, 1}, 12, 0.5f, kGreen};
            HandmadeModel model(true);
            model.add_surfels({front}).add_surfels({back});
            CaptureSettings settings = settings_of(splat);
            settings.force_quads = quads;
            settings.epsilon_scale = 100;
            const Frame frame = renderer.render(unlit(renderer, model), settings);
            const SplatOracle front_oracle(front, splat.camera, splat.width, splat.height, splat.prefilter);
            const SplatOracle back_oracle(back, splat.camera, splat.width, splat.height, splat.prefilter);
            int compared = 0, wrong = 0;
            for (std::uint32_t y = 0; y < splat.height; ++y) {
                for (std::uint32_t x = 0; x < splat.width; ++x) {
                    const SplatPixel a = front_oracle.at(x, y), b = back_oracle.at(x, y);
                    if (std::min(a.certainty, b.certainty) < kUndecided || a.weight + b.weight == 0) continue;
                    const std::uint8_t* pixel = &frame.rgba[4 * (std::size_t{y} * splat.width + x)];
                    const double share = linear(pixel[0]) / (linear(pixel[0]) + linear(pixel[1]));
                    compared += a.weight > 0 ? 1 : 0;
                    // 8-bit encoding is coarse in the dark.
                    if (!(std::abs(share - a.weight / (a.weight + b.weight)) < 0.012)) ++wrong;
                }
            }
            CHECK(compared > 0);
            CHECK(wrong == 0);
        }
    }
}
