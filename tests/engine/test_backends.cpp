// Every backend against the sprites: the same pictures to a stated tolerance, the same bytes every time.
#include "engine/bench/bumpy_sphere.h"
#include "engine/capture/capture.h"
#include "preprocess/build_model/build_model.h"
#include "preprocess/mesh/read_mesh.h"
#include "preprocess/mesh/shapes.h"
#include "tests/engine/handmade_model.h"
#include "tests/engine/test_cameras.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <optional>

using namespace splice;
using namespace splice::test;

namespace {

// All backends compute the same splats; single precision decides otherwise at few pixels only, where a ray meets a
// disk's very edge or two depths are equal. Share of the pixels that may differ by more than a step of 8 bits; all the
// others are at least this near.
constexpr int kSteps = 1;
constexpr double kOddShare = 5e-4;
constexpr double kLeastPsnr = 60;

struct BackendCase {
    const char* name;
    std::function<void(HandmadeModel&)> fill;
    Camera camera;
    bool two_sided = false;
    std::uint32_t width = 203, height = 150;  // pixels; no multiples of a tile
    bool mixed = false;                       // points and another backend must both be in use
};

std::vector<Disk> thick(std::vector<Disk> disks) {
    for (Disk& disk : disks) {
        disk.above = 0.15f * disk.radius;
        disk.below = 0.1f * disk.radius;
    }
    return disks;
}

// Disks of sizes over four decades, turned everywhere.
std::vector<Disk> scattered(int count, float smallest, float largest, float spread) {
    std::vector<Disk> disks;
    std::uint32_t state = 7;
    const auto random = [&] {
        state = state * 1664525u + 1013904223u;
        return static_cast<float>(state >> 8) / 16777216.0f;
    };
    for (int i = 0; i < count; ++i) {
        const glm::vec3 centre =
            spread * (glm::vec3(random(), random(), random()) * 2.0f - 1.0f) - glm::vec3(0, 0, 2 + spread);
        const glm::vec3 normal = glm::vec3(random(), random(), random()) * 2.0f - 1.0f + glm::vec3(0, 0, 0.3f);
        const float radius = smallest * std::pow(largest / smallest, random());
        disks.push_back({centre, normal, radius, 0.3f * radius, 0xff000000u | state >> 8, 0.2f * radius * random(),
                         0.1f * radius * random()});
    }
    return disks;
}

std::vector<BackendCase> backend_cases() {
    const Camera eye = looking_down_z();
    const auto wall = [](float z, int count, std::uint32_t colour) {
        return sheet({-1, -0.8f, z}, {2, 0, 0}, {0, 1.6f, 0}, count, colour);
    };
    return {
        {"a sheet before another, edges inside the picture",
         [&](HandmadeModel& m) {
             m.add_surfels(wall(-3, 30, kBlue))
                 .add_surfels(sheet({-0.4f, -0.3f, -2}, {0.8f, 0.1f, 0}, {0, 0.6f, 0}, 12, kRed));
         },
         eye},
        {"two sheets two epsilon apart",
         [&](HandmadeModel& m) { m.add_surfels(wall(-2, 20, kRed)).add_surfels(wall(-2.2f, 20, kGreen)); }, eye},
        {"grazing sheets",
         [&](HandmadeModel& m) {
             m.add_surfels(thick(sheet({-1, -0.1f, -4}, {2, 0, 0}, {0, 0.02f, 3.5f}, 40, kRed)))
                 .add_surfels(sheet({-1, 0.1f, -1}, {2, 0, 0}, {0, 0, -3}, 30, kGreen));
         },
         eye, true},
        {"across the near plane",
         [&](HandmadeModel& m) {
             m.add_surfels(sheet({-1, -0.3f, 0.3f}, {2, 0, 0}, {0, 0.1f, -2}, 15, kRed))
                 .add_surfels({{{0, -0.4f, 0}, {0, 1, 0}, 5, 0.01f, kBlue}});
         },
         looking_down_z(0.1), true},
        {"centres off the screen, disks of 2,000 pixels",
         [&](HandmadeModel& m) {
             m.add_surfels({{{6, 0, -2}, {0.2f, 0, 1}, 6.5f, 0.01f, kRed},
                            {{-9, 3, -3}, {-0.1f, 0.1f, 1}, 9, 0.01f, kGreen},
                            {{0, 0, -4}, {0, 0.2f, 1}, 30, 0.01f, kBlue}});
         },
         eye, true},
        {"disks of a tenth of a pixel",
         [&](HandmadeModel& m) { m.add_surfels(wall(-40, 60, kRed)).add_surfels(scattered(2000, 4e-4f, 1e-2f, 1)); },
         eye, true},
        {"disks of all sizes", [&](HandmadeModel& m) { m.add_surfels(scattered(3000, 1e-3f, 1, 2)); }, eye, true},
        {"disks of all sizes, parallel rays", [&](HandmadeModel& m) { m.add_surfels(scattered(3000, 1e-3f, 1, 2)); },
         parallel(eye, 3), true},
        {"small disks between large ones",
         [&](HandmadeModel& m) {
             m.add_surfels(wall(-2, 60, kRed))
                 .add_surfels(thick(sheet({-0.6f, -0.5f, -1.9f}, {0.9f, 0.1f, 0}, {0, 0.7f, 0}, 5, kBlue)))
                 .add_surfels(thick(sheet({-0.2f, -0.2f, -1.7f}, {0.5f, 0, 0.05f}, {0, 0.5f, 0}, 60, kGreen)))
                 .add_surfels(sheet({-0.9f, -0.2f, -1.9f}, {1.8f, 0, -0.3f}, {0, 0.3f, 0}, 9, 0xff404040))
                 .add_triangles(quad({-0.1f, -0.6f, -1.8f}, {0.2f, 0, 0}, {0, 1, 0}, kRed));
         },
         eye, false, 203, 150, true},
        {"triangles before, behind and in the plane of surfels",
         [&](HandmadeModel& m) {
             m.add_surfels(wall(-2, 25, kRed))
                 .add_triangles(quad({-0.9f, -0.5f, -1.9f}, {0.5f, 0, 0}, {0, 0.9f, 0}, kGreen))
                 .add_triangles(quad({-0.2f, -0.5f, -2}, {0.5f, 0, 0}, {0, 0.9f, 0}, kGreen))
                 .add_triangles(quad({-3, -3, -2.6f}, {6, 0, 0}, {0, 6, 0}, kBlue))
                 .add_triangles(quad({0.3f, -0.6f, -2.3f}, {0.6f, 0, 0.6f}, {0, 1.2f, 0}, kGreen));
         },
         eye},
        {"the eye inside solid disks",
         [&](HandmadeModel& m) {
             m.add_surfels(wall(-3, 20, kBlue))
                 .add_surfels({{{0.2f, 0, -0.1f}, {0.1f, 0.2f, 1}, 1.5f, 0.02f, kRed, 0.9f, 0.9f},
                               {{0.3f, -0.4f, -1.2f}, {0.3f, 1, 0.2f}, 1.6f, 0.02f, kGreen, 1.2f, 1.2f}});
         },
         eye, true},
        {"centres on the centres of pixels",
         [&](HandmadeModel& m) {
             std::vector<Disk> disks;  // 100 pixels a unit
             for (int y = -30; y < 30; y += 3)
                 for (int x = -40; x < 40; x += 3)
                     disks.push_back({{0.01f * static_cast<float>(x), 0.01f * (static_cast<float>(y) + 0.5f), -2},
                                      {0.2f, 0.1f, 1},
                                      0.001f * static_cast<float>(1 + (x + 46) % 13),
                                      0.01f,
                                      kGreen});
             m.add_surfels(disks);
         },
         parallel(eye, 1.5), true},
        {"nothing but triangles",
         [&](HandmadeModel& m) {
             m.add_triangles(quad({-1, -1, -3}, {2, 0, 0}, {0, 2, 0}, kRed));
         },
         eye},
    };
}

struct Difference {
    int largest = 0;
    double odd_share = 0, psnr = 0;  // psnr: without the odd ones
};

Difference difference(const std::vector<std::uint8_t>& a, const std::vector<std::uint8_t>& b) {
    REQUIRE(a.size() == b.size());
    Difference result;
    double squares = 0;
    std::size_t odd = 0;
    for (std::size_t pixel = 0; pixel < a.size(); pixel += 4) {
        int worst = 0;
        double pixel_squares = 0;
        for (std::size_t i = pixel; i < pixel + 4; ++i) {
            const int off = std::abs(int{a[i]} - int{b[i]});
            worst = std::max(worst, off);
            pixel_squares += off * off;
        }
        result.largest = std::max(result.largest, worst);
        if (worst > kSteps) {
            ++odd;
        } else {
            squares += pixel_squares;
        }
    }
    result.odd_share = static_cast<double>(odd) / static_cast<double>(a.size() / 4);
    result.psnr = squares == 0 ? 1000 : 10 * std::log10(255.0 * 255 * static_cast<double>(a.size()) / squares);
    return result;
}

struct Variant {
    Backend backend;
    std::optional<double> points_below = {};
};
// What each backend does by itself; points beside tiles, and beside rasterised splats.
const Variant kVariants[] = {{Backend::kTile},     {Backend::kRaster},    {Backend::kPoint},
                             {Backend::kTile, 10}, {Backend::kRaster, 8}, {Backend::kAuto}};

void choose(CaptureSettings& settings, const Variant& variant) {
    settings.backend = variant.backend;
    settings.points_below = variant.points_below;
}

bool drew(const Frame& frame, Backend backend) {
    return std::any_of(frame.stats.drawn_by.begin(), frame.stats.drawn_by.end(),
                       [&](const DrawnBy& share) { return share.backend == backend; });
}

// Every backend against the sprites.
void check_agreement(Renderer& renderer, const Scene& scene, CaptureSettings settings, double merge_px = 0) {
    settings.merge_px = merge_px;
    settings.backend = Backend::kSprite;
    const Frame sprite = renderer.render(scene, settings);
    CHECK(sprite.stats.backend == Backend::kSprite);
    for (const Variant& variant : kVariants) {
        choose(settings, variant);
        const Frame frame = renderer.render(scene, settings);
        CAPTURE(name_of(variant.backend), variant.points_below.value_or(-1));
        REQUIRE(!drew(frame, Backend::kSprite));
        CHECK(frame.stats.surfels_drawn == sprite.stats.surfels_drawn);
        const Difference off = difference(sprite.rgba, frame.rgba);
        CAPTURE(off.largest, off.odd_share, off.psnr);
        CHECK(off.odd_share <= kOddShare);
        CHECK(off.psnr >= kLeastPsnr);
        CHECK(renderer.render(scene, settings).rgba == frame.rgba);
    }
}

}  // namespace

TEST_CASE("backends and sprites agree on handmade scenes") {
    Renderer renderer({});
    for (const BackendCase& each : backend_cases()) {
        DYNAMIC_SECTION(each.name) {
            HandmadeModel model(each.two_sided);
            each.fill(model);
            const Scene scene = scene_of(renderer.load(view_of(model.model())));
            CaptureSettings settings;
            settings.width = each.width;
            settings.height = each.height;
            settings.camera = each.camera;
            settings.clip_to_scene = false;
            check_agreement(renderer, scene, settings);
            if (each.mixed) {
                for (const Variant& variant : {Variant{Backend::kTile, 10}, Variant{Backend::kRaster, 10}}) {
                    choose(settings, variant);
                    const Frame frame = renderer.render(scene, settings);
                    CHECK(frame.stats.drawn_by.size() == 2);
                    CHECK(drew(frame, variant.backend));
                    CHECK(drew(frame, Backend::kPoint));
                }
            }
            settings.shading = Shading::kDeferred;
            check_agreement(renderer, scene, settings);
            settings.prefilter = false;
            settings.shading = Shading::kSurfel;
            check_agreement(renderer, scene, settings);
        }
    }
}

TEST_CASE("backends and sprites agree on baked models, transformed, in every view") {
    Renderer renderer({});
    BakeStats stats;
    const auto baked = [&](SourceMesh mesh) {
        RepairReport report;
        return renderer.load(
            view_of(build_model(repair_mesh(std::move(mesh), {}, report, "shape"), BakeOptions{}, stats)));
    };
    const auto sphere = baked(shapes::bumpy_sphere(20'000)), part = baked(shapes::machined_part(48));
    Scene scene;
    scene.instances = {{sphere, {}},
                       {part,
                        {.scale = 0.7,
                         .rotation = glm::dmat3(glm::dvec3(0, 1, 0), glm::dvec3(-1, 0, 0), glm::dvec3(0, 0, 1)),
                         .translation = {0.9, 0.3, 0.2}}},
                       {sphere, {.scale = 0.3, .translation = {-0.8, 0.5, 0.9}}}};
    CaptureSettings settings;
    settings.width = 333;
    settings.height = 250;
    for (const bool orthographic : {false, true}) {
        for (const View view :
             {View::kShaded, View::kDepth, View::kAccumulation, View::kNormals, View::kPatches, View::kRepresentation,
              View::kWireframe, View::kLevels, View::kOverlap, View::kSamples, View::kSurfelsOnly}) {
            settings.camera = frame_camera(scene.bounds(), {.zoom = 1.4, .orthographic = orthographic}, settings.width,
                                           settings.height);
            settings.view = view;
            CAPTURE(static_cast<int>(view), orthographic);
            for (const Shading shading : {Shading::kSurfel, Shading::kDeferred}) {
                settings.shading = shading;
                check_agreement(renderer, scene, settings);
            }
        }
    }
}

TEST_CASE("backends and sprites agree on bumpy spheres in many batches") {
    Renderer renderer({.most_splat_groups = 1000});
    const Scene scene = scene_of(renderer.load(view_of(bench::bumpy_sphere(300'000, 2.4))));
    CaptureSettings settings;
    settings.width = settings.height = 384;
    settings.camera.eye = {0.2, 0.1, 2.3};
    check_agreement(renderer, scene, settings);
}

TEST_CASE("backends and sprites agree on merged surfels") {
    Renderer renderer({});
    const Scene scene = scene_of(renderer.load(view_of(bench::bumpy_sphere(200'000, 4))));
    CaptureSettings settings;
    settings.width = settings.height = 192;
    settings.camera.eye = {0.2, 0.1, 5};
    check_agreement(renderer, scene, settings, kMergePixels);
    CHECK(renderer.render(scene, settings).stats.merged.splats > 10'000);
}

// Minutes, and 2 GB: records and surfels in several bindings.
TEST_CASE("backends and sprites agree on eight million surfels", "[.long]") {
    Renderer renderer({});
    const Scene scene = scene_of(renderer.load(view_of(bench::bumpy_sphere(8'000'000, 2.4))));
    CaptureSettings settings;
    settings.camera.eye = {0.2, 0.1, 2.3};
    check_agreement(renderer, scene, settings);
}

TEST_CASE("a view that tiles cannot draw falls back to sprites and says so") {
    Renderer renderer({});
    HandmadeModel model;
    model.add_surfels(sheet({-1, -1, -2}, {2, 0, 0}, {0, 2, 0}, 8));
    const Scene scene = scene_of(renderer.load(view_of(model.model())));
    CaptureSettings settings;
    settings.backend = Backend::kTile;
    settings.view = View::kVisibility;
    CHECK(renderer.render(scene, settings).stats.backend == Backend::kSprite);
    settings.view = View::kShaded;
    CHECK(renderer.render(scene, settings).stats.backend == Backend::kTile);
}

TEST_CASE("every disk touches every tile") {
    Renderer renderer({});
    std::vector<Disk> disks;
    for (int i = 0; i < 64; ++i)
        disks.push_back({{0, 0, -2 - 0.1f * static_cast<float>(i)}, {0, 0, 1}, 9, 0.01f, kRed});
    HandmadeModel model;
    model.add_surfels(disks);
    CaptureSettings settings;
    settings.camera = looking_down_z();
    settings.clip_to_scene = false;
    check_agreement(renderer, scene_of(renderer.load(view_of(model.model()))), settings);
}

TEST_CASE("the last of more disks than a tile lists at once shows, too") {
    // From far to near; the nearest is alone in its colour.
    for (const bool solid : {false, true}) {
        std::vector<Disk> disks;
        for (int i = 0; i < 1500; ++i)
            disks.push_back({{0, 0, -4 + 0.001f * static_cast<float>(i)}, {0, 0, 1}, 3, 0.0001f, kBlue});
        disks.push_back({{0, 0, -2}, {0, 0, 1}, 0.5f, 0.0001f, kRed});
        HandmadeModel model(true);
        model.add_surfels(solid ? thick(disks) : disks);
        Renderer renderer({});
        CaptureSettings settings;
        settings.width = settings.height = 32;
        settings.camera = looking_down_z();
        CAPTURE(solid);
        check_agreement(renderer, scene_of(renderer.load(view_of(model.model()))), settings);
    }
}

TEST_CASE("frames too large for one batch, and cells too full for one go") {
    // A wall of 40,000 disks is 625 groups: in batches of 100, whole, and seen from so far that all are in few cells.
    HandmadeModel model;
    model.add_surfels(sheet({-1, -0.8f, -2}, {2, 0, 0}, {0, 1.6f, 0}, 200, kRed))
        .add_surfels(sheet({-0.5f, -0.4f, -1.8f}, {1, 0, 0}, {0, 0.8f, 0}, 30, kBlue));
    for (const std::uint64_t most_groups : {std::uint64_t{100}, std::uint64_t{0}}) {
        Renderer renderer({.most_splat_groups = most_groups});
        const Scene scene = scene_of(renderer.load(view_of(model.model())));
        CaptureSettings settings;
        settings.width = 203;
        settings.height = 150;
        settings.camera = looking_down_z();
        for (const double distance : {0.0, 100.0}) {
            settings.camera.eye.z = distance;
            for (const Shading shading : {Shading::kDeferred, Shading::kSurfel}) {
                settings.shading = shading;
                CAPTURE(most_groups, distance, name_of(shading));
                check_agreement(renderer, scene, settings);
            }
        }
        // And the next frame is a small one again.
        HandmadeModel small;
        small.add_surfels(sheet({-1, -1, -2}, {2, 0, 0}, {0, 2, 0}, 8));
        settings.camera.eye.z = 0;
        check_agreement(renderer, scene_of(renderer.load(view_of(small.model()))), settings);
    }
}

TEST_CASE("a cell full of thick disks leaves none out") {
    // All touch the same tiles. 12,800 disks are 200 groups, more than a tile lists at once; 22,400 are 350 groups, and
    // more loops than some drivers allow at once.
    for (const int count : {12800, 22400}) {
        CAPTURE(count);
        std::vector<Disk> disks = scattered(count, 0.03f, 0.04f, 0.01f);
        // Seen nearly edge-on, most of what shows is the sides of solids.
        for (Disk& disk : disks)
            disk.normal = {0.02f, 1, 0.02f};
        HandmadeModel model(true);
        model.add_surfels(thick(disks));
        Renderer renderer({});
        CaptureSettings settings;
        settings.width = settings.height = 64;
        settings.camera = looking_down_z();
        check_agreement(renderer, scene_of(renderer.load(view_of(model.model()))), settings);
    }
}

TEST_CASE("backends and sprites agree on kernels") {
    HandmadeModel model(true);
    model.add_surfels(sheet({-1, -0.8f, -3}, {2, 0, 0}, {0, 1.6f, 0}, 30, kBlue))
        .add_surfels(thick(sheet({-0.4f, -0.3f, -2}, {0.8f, 0.1f, 0}, {0, 0.6f, 0}, 12, kRed)))
        .add_surfels(sheet({-8, -4, -30}, {16, 0, 0}, {0, 8, 0}, 150, kGreen));
    Renderer renderer({});
    Scene scene = scene_of(renderer.load(view_of(model.model())));
    for (const char* kernel : {"gaussian:0.5", "confetti:4,1.5,5", "constant"})
        for (const bool prefilter : {true, false}) {
            CAPTURE(kernel, prefilter);
            CaptureSettings settings;
            settings.width = 203;
            settings.height = 150;
            settings.camera = looking_down_z();
            settings.kernel = parse_kernel(kernel).value();
            settings.prefilter = prefilter;
            scene.background = {.colour = {0.1, 0.4, 0.7}, .transparent = prefilter};
            check_agreement(renderer, scene, settings);
        }
}

TEST_CASE("backends pass the validation layers") {
    Renderer renderer({.validate = true, .most_splat_groups = 10});
    HandmadeModel model;
    model.add_surfels(sheet({-1, -1, -2}, {2, 0, 0}, {0, 2, 0}, 90))
        .add_surfels(sheet({-1, -1, -1.5f}, {2, 0, 0}, {0, 0.5f, 0}, 5))
        .add_triangles(quad({-0.2f, -0.5f, -2}, {0.5f, 0, 0}, {0, 0.9f, 0}, kGreen));
    CaptureSettings settings;
    settings.camera = looking_down_z();
    settings.clip_to_scene = false;
    const Scene scene = scene_of(renderer.load(view_of(model.model())));
    for (const Variant& variant : kVariants) {
        choose(settings, variant);
        for (const std::uint32_t width : {64u, 120u}) {
            settings.width = settings.height = width;
            settings.shading = width == 64 ? Shading::kDeferred : Shading::kSurfel;
            for (int again = 0; again < 2; ++again) {
                const Frame frame = renderer.render(scene, settings);
                CHECK(!drew(frame, Backend::kSprite));
                if (variant.points_below) CHECK(frame.stats.drawn_by.size() == 2);
            }
        }
    }
    CHECK(renderer.validation_messages() == std::vector<std::string>{});
}
