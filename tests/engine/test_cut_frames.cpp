// Frames of cuts: ellipses where they ought to be, the same in every backend, and close to full detail.
#include "engine/capture/calibrate.h"
#include "engine/capture/capture.h"
#include "engine/metrics/image_metrics.h"
#include "engine/scene/patch_view.h"
#include "preprocess/build_model/build_model.h"
#include "preprocess/mesh/read_mesh.h"
#include "preprocess/mesh/shapes.h"
#include "preprocess/model_format/half.h"
#include "preprocess/model_format/octahedral.h"
#include "preprocess/model_format/surfel_extent.h"
#include "preprocess/surfel/surfel_set.h"
#include "tests/engine/frame_colours.h"
#include "tests/engine/frame_holes.h"
#include "tests/engine/handmade_model.h"
#include "tests/engine/mesh_model.h"
#include "tests/engine/test_cameras.h"

#include <catch2/catch.hpp>

#include <cmath>
#include <numbers>
#include <random>

using namespace splice;
using namespace splice::test;

namespace {

// A sphere that bulges, coloured in stripes: a closed cloud of known shape.
PointCloud striped_sphere(std::size_t count) {
    std::mt19937 random(5);
    std::normal_distribution<float> normal;
    PointCloud cloud;
    cloud.source_points = count;
    for (std::size_t i = 0; i < count; ++i) {
        const Vec3f n = Vec3f(normal(random), normal(random), normal(random)).normalized();
        cloud.offsets.push_back((1 + 0.08f * std::sin(7 * n.x()) * std::sin(6 * n.y())) * n);
        cloud.colours.push_back(std::sin(20 * n.z()) > 0 ? 0xff3060e0u : 0xffe0d0a0u);
    }
    return cloud;
}

Model cloud_model(std::size_t count) {
    BakeStats stats;
    return build_cloud_model(striped_sphere(count), {}, stats);
}

std::vector<glm::dvec3> directions() {
    std::vector<glm::dvec3> all;
    for (int x = -1; x <= 1; ++x)
        for (int y = -1; y <= 1; ++y)
            for (int z = -1; z <= 1; ++z)
                if (x != 0 || y != 0 || z != 0) all.push_back(glm::normalize(glm::dvec3(x, y, z)));
    return all;
}

Camera camera_at(const Box& bounds, const glm::dvec3& direction, double distance) {
    Camera camera;
    camera.target = bounds.centre();
    camera.eye = camera.target + direction * (distance * bounds.radius());
    camera.up = std::abs(direction.y) > 0.9 ? glm::dvec3(0, 0, -1) : glm::dvec3(0, 1, 0);
    camera.fov_y_degrees = 40;
    return camera;
}

CaptureSettings small_picture() {
    CaptureSettings settings;
    settings.width = settings.height = 192;
    settings.backend = Backend::kTile;
    settings.merge_px = 0;
    return settings;
}

}  // namespace

TEST_CASE("an ellipse covers its own pixels, in both backends") {
    // One node of two disks; what is drawn of it is an ellipse turned by 30 degrees, facing the eye.
    HandmadeModel handmade(true);
    handmade.add_surfels(
        {{{-0.2f, 0, -0.5f}, {0, 0, 1}, 0.1f, 0.01f, kRed}, {{0.2f, 0, -0.5f}, {0, 0, 1}, 0.1f, 0.01f, kRed}});
    Model model = handmade.model();
    format::PointNode node{};
    node.position[2] = -0.5f;
    node.sphere_radius = 0.6f;
    node.normal = encode_octahedral(0, 0, 1);
    const double turn = std::numbers::pi / 6;
    node.major_axis = encode_octahedral(static_cast<float>(std::cos(turn)), static_cast<float>(std::sin(turn)), 0);
    node.major = 0.6f;
    node.minor = 0.2f;
    node.colour[1] = 255;
    node.cone_angle = 1;
    node.extent = encode_extent({0, 0, 0.01f}, node.major);
    node.surfel_count = 2;
    model.point_tree = pack_point_tree({&node, 1});
    Renderer renderer({});
    const Scene scene = scene_of(renderer.load(view_of(model)));
    CaptureSettings settings;
    settings.width = 200;
    settings.height = 160;
    settings.camera = parallel(looking_down_z(), 2);
    settings.clip_to_scene = false;
    settings.prefilter = false;
    settings.tau = 500;
    for (const Backend backend : {Backend::kSprite, Backend::kTile}) {
        settings.backend = backend;
        for (const bool quads : {false, true}) {
            settings.force_quads = quads;
            const Frame frame = renderer.render(scene, settings);
            CAPTURE(static_cast<int>(backend), quads);
            CHECK(frame.stats.surfels_drawn == 1);
            CHECK(frame.stats.cut.counts.ellipses == 1);
            std::size_t wrong = 0, covered = 0;
            for (std::uint32_t y = 0; y < settings.height; ++y)
                for (std::uint32_t x = 0; x < settings.width; ++x) {
                    const double px = (x + 0.5 - 100) / 80, py = (80 - (y + 0.5)) / 80;
                    const double u = px * std::cos(turn) + py * std::sin(turn),
                                 v = py * std::cos(turn) - px * std::sin(turn);
                    // Rounded up by up to 2 % (ellipse_record.h), and less than a pixel's share beside.
                    const bool within = std::hypot(u / 0.6, v / 0.2) < 1;
                    const bool beyond = std::hypot(u / 0.6, v / 0.2) > 1.05;
                    const bool shown = frame.coverage[y * settings.width + x] != 0;
                    covered += shown;
                    wrong += (within && !shown) || (beyond && shown);
                }
            CHECK(wrong == 0);
            CHECK(covered > 2300);
        }
    }
    settings.tau = 0;
    CHECK(renderer.render(scene, settings).stats.surfels_drawn == 2);
}

TEST_CASE("tiles and sprites draw the same cut") {
    const Model model = cloud_model(20000);
    Renderer renderer({});
    const Scene scene = scene_of(renderer.load(view_of(model)));
    CaptureSettings settings = small_picture();
    for (const double tau : {6.0, 20.0}) {
        for (const bool orthographic : {false, true}) {
            settings.camera = frame_camera(scene.bounds(), {.orthographic = orthographic}, 192, 192);
            settings.tau = tau;
            settings.backend = Backend::kTile;
            const Frame tile = renderer.render(scene, settings);
            CHECK(renderer.render(scene, settings).rgba == tile.rgba);
            settings.backend = Backend::kSprite;
            const Frame sprite = renderer.render(scene, settings);
            CAPTURE(tau, orthographic);
            CHECK(tile.stats.cut.counts == sprite.stats.cut.counts);
            CHECK(tile.stats.cut.counts.ellipses > 100);
            CHECK(metrics::psnr(colours_of(tile), colours_of(sprite)) > 50);
            CHECK(holes(tile, sprite) + holes(sprite, tile) <= 4);
        }
    }
}

TEST_CASE("a cut of surfels alone is full detail") {
    const Model model = cloud_model(20000);
    Renderer renderer({});
    const Scene scene = scene_of(renderer.load(view_of(model)));
    CaptureSettings settings = small_picture();
    settings.camera = frame_camera(scene.bounds(), {.zoom = 2}, 192, 192);
    const Frame full = renderer.render(scene, settings);
    settings.tau = 1e-6;
    const Frame cut = renderer.render(scene, settings);
    CHECK(cut.stats.cut.counts.ellipses == 0);
    CHECK(cut.stats.cut.counts.outside_frustum > 0);
    CHECK(holes(full, cut) + holes(cut, full) == 0);
    CHECK(metrics::psnr(colours_of(cut), colours_of(full)) > 60);
}

// As `settings` at full detail, 64 samples a pixel.
metrics::ColourImage truth_of(Renderer& renderer, const Scene& scene, CaptureSettings settings) {
    settings.tau = 0;
    settings.antialias = 8;
    return colours_of(renderer.render(scene, settings));
}

TEST_CASE("ellipses of a pixel are no farther from the truth than the surfels they stand for") {
    const Model model = cloud_model(150'000);
    Renderer renderer({});
    const Scene scene = scene_of(renderer.load(view_of(model)));
    for (const double zoom : {0.5, 0.25}) {
        CaptureSettings settings = small_picture();
        settings.camera = frame_camera(scene.bounds(), {.zoom = zoom}, 192, 192);
        const Frame full = renderer.render(scene, settings);
        settings.tau = 1;
        const Frame cut = renderer.render(scene, settings);
        const metrics::ColourImage truth = truth_of(renderer, scene, settings);
        CAPTURE(zoom, cut.stats.cut.counts.merged_surfels, cut.stats.surfels_drawn, full.stats.covered_pixels);
        CHECK(cut.stats.cut.counts.merged_surfels > (zoom < 0.5 ? 90'000 : 10'000));
        CHECK(cut.stats.surfels_drawn < full.stats.surfels_drawn);
        CHECK(metrics::psnr(colours_of(cut), colours_of(full)) > 39);
        CHECK(metrics::psnr(colours_of(cut), truth) > metrics::psnr(colours_of(full), truth));
        CHECK(holes(full, cut) == 0);
        CHECK(static_cast<double>(cut.stats.covered_pixels) < 1.01 * static_cast<double>(full.stats.covered_pixels));
    }
}

TEST_CASE("cuts leave no hole, from near and far") {
    const Model model = GENERATE(0, 1) == 0 ? cloud_model(30000) : mesh_model();
    Renderer renderer({});
    const Scene scene = scene_of(renderer.load(view_of(model)));
    CaptureSettings settings = small_picture();
    const std::vector<glm::dvec3> all = directions();
    std::size_t bare = 0, covered = 0;
    std::uint64_t groups = 0;
    for (std::size_t i = 0; i < all.size(); i += 5)
        for (const double distance : {1.2, 2.0, 4.0, 9.0, 25.0, 100.0}) {
            settings.camera = camera_at(scene.bounds(), all[i], distance);
            settings.tau = 0;
            const Frame full = renderer.render(scene, settings);
            for (const double tau : {1.0, 4.0}) {
                settings.tau = tau;
                const Frame cut = renderer.render(scene, settings);
                bare += holes(full, cut);
                groups += cut.stats.cut.counts.groups_by_triangles;
            }
            covered += full.stats.covered_pixels;
        }
    CHECK(covered > 100'000);
    CHECK(bare == 0);
    CHECK((groups > 0) == !model.indices.empty());
}

TEST_CASE("triangles of patches that face away are not drawn, and nothing is missing") {
    // Two-sided, nothing is culled: of a closed surface that shows the same depths.
    const Model model = mesh_model();
    Renderer renderer({});
    const Scene scene = scene_of(renderer.load(view_of(model)));
    CaptureSettings settings = small_picture();
    settings.shown = Shown::kTriangles;
    settings.want_depth = true;
    for (const double distance : {1.2, 2.0, 9.0})
        for (const bool parallel_rays : {false, true}) {
            settings.camera = camera_at(scene.bounds(), glm::normalize(glm::dvec3(1, 2, 3)), distance);
            if (parallel_rays) settings.camera = parallel(settings.camera, distance);
            settings.sides = Sides::kTwoSided;
            const Frame all = renderer.render(scene, settings);
            settings.sides = Sides::kOneSided;
            const Frame front = renderer.render(scene, settings);
            CAPTURE(distance, parallel_rays);
            CHECK(all.stats.covered_pixels > 500);
            CHECK(static_cast<double>(front.stats.triangles_drawn) <
                  0.8 * static_cast<double>(all.stats.triangles_drawn));
            CHECK(front.coverage == all.coverage);
            std::size_t other = 0;
            for (std::size_t i = 0; i < all.depth.size(); ++i)
                other += front.depth[i] != all.depth[i];
            CHECK(other <= 1);  // at the outline, where the device culls a triangle on edge itself
        }
}

TEST_CASE("zooming out changes no pixel by a jump") {
    // Every step shows the model a hundredth smaller. With a cut, neighbouring frames differ hardly more than at full
    // detail.
    const Model model = GENERATE(0, 1) == 0 ? cloud_model(60000) : mesh_model();
    Renderer renderer({});
    const Scene scene = scene_of(renderer.load(view_of(model)));
    CaptureSettings settings = small_picture();
    const auto mean_step = [&](double tau) {
        settings.tau = tau;
        std::optional<Frame> before;
        double sum = 0, largest = 0;
        for (int step = 0; step < 12; ++step) {
            settings.camera = camera_at(scene.bounds(), glm::normalize(glm::dvec3(1, 1, 2)), 4 * std::pow(1.01, step));
            Frame frame = renderer.render(scene, settings);
            if (before) {
                double change = 0;
                for (std::size_t i = 0; i < frame.rgba.size(); ++i)
                    change += std::abs(int{frame.rgba[i]} - int{before->rgba[i]});
                sum += change;
                largest = std::max(largest, change);
            }
            before = std::move(frame);
        }
        return std::pair{sum / 11, largest};
    };
    const auto [full, full_largest] = mean_step(0);
    const auto [cut, cut_largest] = mean_step(1);
    CAPTURE(full, full_largest, cut, cut_largest);
    CHECK(cut < 1.1 * full);
    CHECK(cut_largest < 1.2 * full_largest);
}

TEST_CASE("a mesh's model takes the cheaper of triangles and surfels, patch by patch") {
    const Model model = mesh_model();
    Renderer renderer({});
    const Scene scene = scene_of(renderer.load(view_of(model)));
    CaptureSettings settings = small_picture();
    settings.camera = frame_camera(scene.bounds(), {}, 192, 192);
    const Frame full = renderer.render(scene, settings);
    settings.tau = 1;
    const Frame cut = renderer.render(scene, settings);
    const CutStatistics& counts = cut.stats.cut.counts;
    CAPTURE(counts.patches_by_triangles, counts.surfels, counts.ellipses, cut.stats.triangles_drawn);
    CHECK(counts.patches_by_triangles > 0);
    CHECK(cut.stats.triangles_drawn + cut.stats.surfels_drawn < full.stats.triangles_drawn + full.stats.surfels_drawn);
    CHECK(holes(full, cut) == 0);
    // Disks overhang outlines and creases; the triangles in their place do not. That is what differs.
    CHECK(metrics::psnr(colours_of(cut), colours_of(full)) > 34);
    CaptureSettings triangles = settings;
    triangles.shown = Shown::kTriangles;
    const metrics::ColourImage truth = truth_of(renderer, scene, triangles);
    CHECK(metrics::psnr(colours_of(cut), truth) > metrics::psnr(colours_of(full), truth) + 0.5);
    // Without triangles to choose from, surfels.
    settings.view = View::kSurfelsOnly;
    const Frame surfels = renderer.render(scene, settings);
    CHECK(surfels.stats.cut.counts.patches_by_triangles == 0);
    CHECK(surfels.stats.surfels_drawn > cut.stats.surfels_drawn);
}

TEST_CASE("every patch is counted once, as drawn or as culled by what") {
    const Model model = mesh_model();
    Renderer renderer({});
    const Scene scene = scene_of(renderer.load(view_of(model)));
    const auto patches = model.patches.size();
    const auto counted = [&](double distance, double tau, Sides sides, bool triangles = true) {
        CaptureSettings settings = small_picture();
        settings.camera = camera_at(scene.bounds(), glm::normalize(glm::dvec3(1, 2, 3)), distance);
        settings.camera.target += glm::dvec3(0.3 * scene.bounds().radius(), 0, 0);
        settings.tau = tau;
        settings.sides = sides;
        settings.draw_triangles = triangles;
        const PatchCounts counts = renderer.render(scene, settings).stats.patches;
        CAPTURE(distance, tau);
        CHECK(counts.drawn + counts.in_groups + counts.in_cut + counts.outside_frustum + counts.facing_away +
                  counts.unwanted ==
              patches);
        return counts;
    };
    const PatchCounts far = counted(4, 0, Sides::kTwoSided);
    CHECK(far == PatchCounts{.drawn = patches});
    const PatchCounts away = counted(4, 0, Sides::kOneSided);
    CHECK(away.facing_away > patches / 8);
    CHECK(away.facing_away < patches / 2);
    CHECK(away.outside_frustum == 0);
    const PatchCounts near = counted(1.2, 0, Sides::kTwoSided);
    CHECK(near.outside_frustum > patches / 8);
    CHECK(near.facing_away == 0);
    // Whether a node is outside as a whole changes no count.
    Camera camera = camera_at(scene.bounds(), glm::normalize(glm::dvec3(1, 2, 3)), 1.2);
    camera.target += glm::dvec3(0.3 * scene.bounds().radius(), 0, 0);
    fit_clip_planes(camera, scene.drawn_bounds());
    const DrawList draws = build_draw_list(scene, camera, 192, 192, {.sides = Sides::kTwoSided});
    const PatchView seen(camera, 192, 192, draws.instances[0].model_to_view, draws.instances[0].scale);
    CHECK(near.outside_frustum == static_cast<std::uint64_t>(std::count_if(
                                      model.patches.begin(), model.patches.end(), [&](const format::Patch& patch) {
                                          return seen.locate(patch.bounds_min, patch.bounds_max).containment ==
                                                 Containment::kOutside;
                                      })));
    const PatchCounts cut = counted(2, 0.5, Sides::kOneSided);
    CHECK(cut.in_cut > 0);
    CHECK(counted(4, 1000, Sides::kOneSided) == PatchCounts{.in_groups = patches});
    const PatchCounts surfels = counted(4, 0, Sides::kTwoSided, false);
    CHECK(surfels.unwanted > patches / 8);
    CHECK(surfels.drawn == patches - surfels.unwanted);
}

TEST_CASE("a budget is held: the predicted time is within a fifth of it, and no more") {
    const Model model = GENERATE(0, 1) == 0 ? cloud_model(60'000) : mesh_model();
    Renderer renderer({});
    const Scene scene = scene_of(renderer.load(view_of(model)));
    CaptureSettings settings = small_picture();
    settings.camera = frame_camera(scene.bounds(), {}, 192, 192);
    const double full = renderer.render(scene, settings).stats.predicted_ms;
    // What is left when nothing is coarse enough: the pixels.
    settings.tau = 1000;
    const double least = renderer.render(scene, settings).stats.predicted_ms;
    settings.tau = 0;
    REQUIRE(least < 0.5 * full);
    for (const double share : {0.9, 0.7, 0.5, 0.3}) {
        settings.budget_ms = least + share * (full - least);
        const Frame frame = renderer.render(scene, settings);
        CAPTURE(share, *settings.budget_ms, frame.stats.predicted_ms, frame.stats.cut.tau);
        CHECK(frame.stats.predicted_ms <= *settings.budget_ms);
        // Triangles that take the place of surfels at once may be a step down from full detail.
        if (frame.stats.cut.tau > 0.1) CHECK(frame.stats.predicted_ms >= 0.8 * *settings.budget_ms);
        CHECK(frame.stats.cut.tau > 0);
        CHECK(frame.stats.cut.budget_ms == settings.budget_ms);
        // It is the frame of that tau, whatever chose it.
        CaptureSettings same = settings;
        same.budget_ms.reset();
        same.tau = frame.stats.cut.tau;
        CHECK(renderer.render(scene, same).rgba == frame.rgba);
    }
    settings.budget_ms = 2 * full;
    CHECK(renderer.render(scene, settings).stats.cut.tau == 0);
    settings.budget_ms = 0.5 * least;
    CHECK(renderer.render(scene, settings).stats.predicted_ms < 1.01 * least);
}

TEST_CASE("a calibration measures every cost that the device has") {
    Renderer renderer({});
    const Calibration calibration = calibrate(renderer, Backend::kTile);
    CHECK(calibration.costs.frame_pixel > 0);
    CHECK(calibration.costs.triangle + calibration.costs.triangle_hit + calibration.costs.triangle_pixel > 0);
    CHECK(calibration.costs.splat > 0);
    CHECK(calibration.costs.splat_pixel >= 0);
    CHECK(calibration.samples.size() > 7);
}

TEST_CASE("levels of detail may be chosen from elsewhere than they are looked at from") {
    const Model model = cloud_model(60'000);
    Renderer renderer({});
    const Scene scene = scene_of(renderer.load(view_of(model)));
    CaptureSettings settings = small_picture();
    settings.tau = 2;
    settings.camera = frame_camera(scene.bounds(), {.zoom = 0.3}, 192, 192);
    const Frame far = renderer.render(scene, settings);
    settings.cut_camera = settings.camera;
    const Frame frozen = renderer.render(scene, settings);
    CHECK(frozen.stats.cut.counts.ellipses == far.stats.cut.counts.ellipses);
    CHECK(frozen.stats.cut.counts.surfels == far.stats.cut.counts.surfels);
    CHECK(metrics::psnr(colours_of(frozen), colours_of(far)) > 50);
    // From near, the same few ellipses; chosen from here there would be more.
    settings.camera = frame_camera(scene.bounds(), {.azimuth_degrees = 100, .zoom = 1}, 192, 192);
    for (const Backend backend : {Backend::kTile, Backend::kSprite}) {
        settings.backend = backend;
        const Frame near = renderer.render(scene, settings);
        CHECK(near.stats.surfels_drawn == far.stats.surfels_drawn);
        CHECK(near.stats.covered_pixels > 3 * far.stats.covered_pixels);
    }
    settings.cut_camera.reset();
    CHECK(renderer.render(scene, settings).stats.surfels_drawn > 2 * far.stats.surfels_drawn);
}

TEST_CASE("kernels: the same picture from both backends, and a plain surface stays plain") {
    HandmadeModel handmade(true);
    handmade.add_surfels(sheet({-1, -1, -2}, {2, 0.2f, 0}, {0, 2, 0.6f}, 24, kRed));
    Renderer renderer({});
    const Scene plain = scene_of(renderer.load(view_of(handmade.model())));
    const Model model = cloud_model(5000);
    const Scene cloud = scene_of(renderer.load(view_of(model)));
    CaptureSettings settings = small_picture();
    settings.camera = looking_down_z();
    settings.clip_to_scene = false;
    const Frame usual = renderer.render(plain, settings);
    for (const char* name :
         {"gaussian:0.3", "gaussian:0.8", "confetti:1,1.5,2", "confetti:6,1.5,3", "confetti:4,1.5,5", "constant"}) {
        for (const bool prefilter : {true, false}) {
            CAPTURE(name, prefilter);
            settings.kernel = parse_kernel(name).value();
            settings.prefilter = prefilter;
            settings.camera = looking_down_z();
            settings.clip_to_scene = false;
            settings.backend = Backend::kTile;
            const Frame tile = renderer.render(plain, settings);
            CHECK(tile.coverage == usual.coverage);
            CHECK(metrics::psnr(colours_of(tile), colours_of(usual)) > 45);
            settings.camera = frame_camera(cloud.bounds(), {}, 192, 192);
            settings.clip_to_scene = true;
            const Frame cloud_tile = renderer.render(cloud, settings);
            settings.backend = Backend::kSprite;
            const Frame cloud_sprite = renderer.render(cloud, settings);
            CHECK(metrics::psnr(colours_of(cloud_tile), colours_of(cloud_sprite)) > 45);
            // And not the picture of another kernel.
            settings.kernel = {};
            CHECK(metrics::psnr(colours_of(renderer.render(cloud, settings)), colours_of(cloud_sprite)) < 60);
        }
    }
}
