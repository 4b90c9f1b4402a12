#include "engine/bench/frame/bench_frame.h"

#include "engine/bench/bumpy_sphere.h"
#include "engine/bench/frame/bare_sprites.h"
#include "engine/bench/report/progress.h"
#include "engine/capture/capture.h"
#include "engine/capture/load_scene.h"

#include <fmt/format.h>

#include <ctime>
#include <functional>
#include <memory>

namespace splice::bench {
namespace {

constexpr double kSphereDepth = 10;
// The eye's distance at which the sphere covers 46 % and 13 % of a square frame.
constexpr double kNear = 2.5, kFar = 4.4;
constexpr std::uint32_t kFarDisks = 1'000'000;

struct BenchScene {
    std::string name;
    Scene scene;
    Camera camera;
    Model model = {};  // of a sphere, for the baseline
};

/// Of all threads of the process.
double cpu_ms() {
    timespec now{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return static_cast<double>(now.tv_sec) * 1e3 + static_cast<double>(now.tv_nsec) * 1e-6;
}

BenchScene sphere_scene(Renderer& renderer, std::uint32_t count, double distance) {
    BenchScene bench{fmt::format("bumpy-sphere {}{}", count, distance == kFar ? " far" : ""), {}, {}};
    bench.model = bumpy_sphere(count, kSphereDepth);
    bench.scene = scene_of(renderer.load(view_of(bench.model)));
    bench.camera.eye = {0, 0, distance};
    bench.camera.fov_y_degrees = 60;
    return bench;
}

/// A variant and what was measured of it.
struct Variant {
    FrameRow row;
    CaptureSettings settings;
    BareSprites* bare = nullptr;  // instead of the renderer
    std::vector<double> wall = {}, cpu = {};
    std::vector<std::pair<std::string, std::vector<double>>> passes = {};
};

void run(Renderer& renderer, const BenchScene& bench, Variant& variant, bool timed) {
    const double before = cpu_ms();
    FrameStats stats =
        variant.bare ? variant.bare->render(variant.settings) : renderer.render(bench.scene, variant.settings).stats;
    const double cpu = cpu_ms() - before;
    FrameRow& row = variant.row;
    row.surfels = stats.surfels_drawn;
    row.triangles = stats.triangles_drawn;
    if (!variant.bare) row.covered_pixels = stats.covered_pixels;
    row.drawn_by.clear();
    for (const DrawnBy& share : stats.drawn_by)
        row.drawn_by.emplace_back(name_of(share.backend), share.surfels);
    if (!timed) return;
    variant.cpu.push_back(cpu);
    variant.wall.push_back(stats.frame_ms);
    variant.passes.resize(stats.passes.size());
    for (std::size_t i = 0; i < stats.passes.size(); ++i) {
        variant.passes[i].first = stats.passes[i].name;
        variant.passes[i].second.push_back(stats.passes[i].gpu_ms);
    }
}

void measure(Renderer& renderer, const BenchScene& bench, const FrameBenchOptions& options, FrameReport& report) {
    std::vector<Backend> backends = options.backends;
    if (backends.empty())
        backends = {Backend::kSprite, Backend::kRaster, Backend::kTile, Backend::kPoint, Backend::kAuto};
    std::unique_ptr<BareSprites> bare;
    if (options.bare && !bench.model.surfels.empty()) bare = std::make_unique<BareSprites>(options.device, bench.model);
    for (const auto& [width, height] : options.sizes) {
        CaptureSettings settings;
        settings.width = width;
        settings.height = height;
        settings.camera = bench.camera;
        if (bench.model.surfels.empty()) settings.camera = frame_camera(bench.scene.bounds(), {}, width, height);
        fit_clip_planes(settings.camera, bench.scene.drawn_bounds());
        settings.merge_px = options.merge_px;
        settings.want_overlap = true;
        const FrameStats counted = renderer.render(bench.scene, settings).stats;
        settings.want_overlap = false;
        std::vector<Variant> variants;
        const auto add = [&](const std::string& name, Shading shading, Backend backend, BareSprites* instead) {
            Variant variant{.row = {}, .settings = settings, .bare = instead};
            variant.settings.backend = backend;
            variant.settings.points_below = options.points_below;
            variant.settings.shading = shading;
            variant.row.scene = bench.name;
            variant.row.backend = name;
            variant.row.shading = name_of(shading);
            variant.row.width = width;
            variant.row.height = height;
            variant.row.fragments = counted.fragments;
            variant.row.covered_pixels = counted.covered_pixels;
            variants.push_back(std::move(variant));
        };
        for (const Shading shading : options.shadings)
            for (const Backend backend : backends)
                add(std::string(name_of(backend)), shading, backend, nullptr);
        if (bare) add("bare", Shading::kSurfel, Backend::kSprite, bare.get());
        for (unsigned round = 0; round <= options.rounds; ++round) {
            show_progress(fmt::format("{}: {} of {}", bench.name, round, options.rounds));
            for (Variant& variant : variants)
                run(renderer, bench, variant, round > 0);  // the first compiles shaders
        }
        for (Variant& variant : variants) {
            variant.row.frame_ms = summarise(variant.wall);
            variant.row.cpu_ms = summarise(variant.cpu);
            for (auto& [name, values] : variant.passes)
                variant.row.passes.push_back({name, summarise(values)});
            report.rows.push_back(std::move(variant.row));
        }
    }
}

}  // namespace

FrameReport bench_frame(const FrameBenchOptions& options) {
    constexpr std::uint32_t kMostPlans = 64;  // a variant each, and no frame makes one anew
    Renderer renderer({.device = options.device, .graph = {.max_plans = kMostPlans}});
    FrameReport report{.device = renderer.device_name(), .rounds = options.rounds, .rows = {}};
    const auto sphere = [&](std::uint32_t count, double distance) {
        measure(renderer, sphere_scene(renderer, count, distance), options, report);
    };
    for (const auto& path : options.files)
        measure(renderer, {path.stem().string(), load_scene(path, renderer).scene, {}}, options, report);
    for (const std::uint32_t count : options.counts) {
        sphere(count, kNear);
        if (options.far) sphere(count, kFar);
    }
    if (options.files.empty() && options.counts.empty()) {
        for (const std::uint32_t count : {50'000u, 300'000u, kFarDisks})
            sphere(count, kNear);
        sphere(kFarDisks, kFar);
    }
    show_progress("");
    return report;
}

}  // namespace splice::bench
