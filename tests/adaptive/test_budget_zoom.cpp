// Holding a frame time while the camera zooms in and out: by prediction (--budget), and by what frames took (the
// window's frames in motion). No clock is read: a frame takes what the costs predict of what it draws, times how much
// slower or faster than the table the machine is said to be.
#include "engine/capture/capture.h"
#include "engine/scene/frame_budget.h"
#include "engine/viewer/resolution.h"
#include "preprocess/build_model/build_model.h"
#include "tests/engine/mesh_model.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

using namespace splice;
using namespace splice::test;

namespace {

constexpr std::uint32_t kSize = 256;
constexpr double kFinestTau = 0.0625;  // pixels

Model cloud_model() {
    std::mt19937 random(5);
    std::normal_distribution<float> normal;
    PointCloud cloud;
    cloud.source_points = 80'000;
    for (std::size_t i = 0; i < cloud.source_points; ++i) {
        const Vec3f n = Vec3f(normal(random), normal(random), normal(random)).normalized();
        cloud.offsets.push_back((1 + 0.08f * std::sin(7 * n.x()) * std::sin(6 * n.y())) * n);
    }
    BakeStats stats;
    return build_cloud_model(std::move(cloud), {}, stats);
}

// From where the model is a fifth of the picture high to where it fills it, and back, twice.
Camera camera_of(const Scene& scene, int frame, int frames) {
    const double turn = 4 * std::numbers::pi * frame / frames;
    Camera camera =
        frame_camera(scene.bounds(), {.azimuth_degrees = 20 + 0.2 * frame, .zoom = std::pow(0.45, 1 + std::cos(turn))},
                     kSize, kSize);
    fit_clip_planes(camera, scene.drawn_bounds());
    return camera;
}

double predicted(const Scene& scene, const Camera& camera, double share, double tau) {
    const auto size = static_cast<std::uint32_t>(share * kSize);
    return build_draw_list(scene, camera, size, size, {.merge_px = 0.5, .tau = tau}).predicted_ms;
}

}  // namespace

TEST_CASE("a budget is held to a fifth in every frame of a zoom") {
    const Model model = GENERATE(0, 1) == 0 ? cloud_model() : mesh_model();
    Renderer renderer({});
    const Scene scene = scene_of(renderer.load(view_of(model)));
    constexpr int kFrames = 60;
    std::vector<double> full, least;
    for (int i = 0; i < kFrames; ++i) {
        // Triangles may take the place of surfels at once: finer than this is a step that no tau is between.
        full.push_back(predicted(scene, camera_of(scene, i, kFrames), 1, kFinestTau));
        least.push_back(predicted(scene, camera_of(scene, i, kFrames), 1, 1000));
    }
    const double budget =
        0.5 * (*std::max_element(least.begin(), least.end()) + *std::max_element(full.begin(), full.end()));
    int held = 0, spare = 0, below = 0;
    for (int i = 0; i < kFrames; ++i) {
        const BudgetedDraws chosen =
            build_within_budget(scene, camera_of(scene, i, kFrames), kSize, kSize, {.merge_px = 0.5}, budget);
        CAPTURE(i, budget, full[static_cast<std::size_t>(i)], chosen.draws.predicted_ms, chosen.tau);
        CHECK(chosen.draws.predicted_ms <= budget);
        if (full[static_cast<std::size_t>(i)] <= budget) {
            CHECK(chosen.tau <= kFinestTau);
            ++spare;
        } else {
            ++held;
            below += chosen.draws.predicted_ms < 0.8 * budget;
        }
    }
    CAPTURE(held, spare, below);
    CHECK(held > kFrames / 4);
    CHECK(spare > kFrames / 10);
    CHECK(below == 0);
}

TEST_CASE("in motion, few frames of a zoom take longer than the budget, also on a machine that slows down") {
    const Model model = GENERATE(0, 1) == 0 ? cloud_model() : mesh_model();
    const double later_slowness = GENERATE(1.0, 1.7);
    Renderer renderer({});
    const Scene scene = scene_of(renderer.load(view_of(model)));
    constexpr int kFrames = 400, kSettling = 20;
    double full = 0, least = 0;
    for (int i = 0; i < kFrames; i += 10) {
        full = std::max(full, predicted(scene, camera_of(scene, i, kFrames), 0.5, 0));
        least = std::max(least, predicted(scene, camera_of(scene, i, kFrames), 0.5, MovingDetail::kCoarsest));
    }
    const double budget = 0.5 * (least + full);
    REQUIRE(later_slowness * least < budget);
    MovingDetail detail;
    std::mt19937 random(3);
    std::uniform_real_distribution<double> noise(0.97, 1.03);
    int slow = 0, coarser = 0;
    double sum = 0;
    for (int i = 0; i < kFrames; ++i) {
        const double slowness = noise(random) * (i < kFrames / 2 ? 1 : later_slowness);
        const double ms = slowness * predicted(scene, camera_of(scene, i, kFrames), detail.share(), detail.tau());
        // The first frames find out how coarse it has to be.
        if (i >= kSettling) {
            slow += ms > 1.2 * budget;
            coarser += detail.tau() > 0;
            sum += ms;
        }
        detail.took(ms, budget);
    }
    CAPTURE(later_slowness, budget, slow, coarser, sum / (kFrames - kSettling) / budget);
    CHECK(coarser > kFrames / 4);
    CHECK(slow <= 0.04 * kFrames);
    // Finer steps wait, so that frames are seldom slow: on the whole there is time left, though not most of it.
    CHECK(sum > 0.45 * budget * (kFrames - kSettling));
}
