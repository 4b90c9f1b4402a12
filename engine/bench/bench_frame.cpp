#include "engine/bench/bench_frame.h"

#include "engine/bench/bumpy_sphere.h"
#include "engine/bench/table.h"
#include "engine/capture/capture.h"
#include "engine/capture/load_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <ctime>
#include <functional>

namespace splice::bench {

namespace {

constexpr double kSphereDepth = 10;
constexpr Backend kBackends[] = {Backend::kSprite, Backend::kRaster, Backend::kTile, Backend::kPoint, Backend::kAuto};

struct BenchScene {
    std::string name;
    Scene scene;
    Camera camera;
};

struct Times {
    std::vector<double> wall, cpu;  // milliseconds a frame
    FrameStats best;                // of the fastest frame
};

/// Of all threads of the process: what a busy machine distorts least.
double cpu_ms() {
    timespec now{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return static_cast<double>(now.tv_sec) * 1e3 + static_cast<double>(now.tv_nsec) * 1e-6;
}

BenchScene sphere_scene(Renderer& renderer, std::uint32_t count) {
    BenchScene bench{"bumpy-sphere " + std::to_string(count),
                     scene_of(renderer.load(view_of(bumpy_sphere(count, kSphereDepth)))),
                     {}};
    bench.camera.eye = {0, 0, 2.5};
    bench.camera.fov_y_degrees = 60;
    return bench;
}

BenchScene file_scene(Renderer& renderer, const std::filesystem::path& path, const FrameBenchOptions& options) {
    BenchScene bench{path.stem().string(), load_scene(path, renderer).scene, {}};
    bench.camera = frame_camera(bench.scene.bounds(), {}, options.width, options.height);
    return bench;
}

std::vector<Times> measure(Renderer& renderer, const BenchScene& bench, const FrameBenchOptions& options) {
    CaptureSettings settings;
    settings.width = options.width;
    settings.height = options.height;
    settings.camera = bench.camera;
    std::vector<Times> times(std::size(kBackends));
    for (unsigned round = 0; round <= options.rounds; ++round) {
        for (std::size_t i = 0; i < std::size(kBackends); ++i) {
            settings.backend = kBackends[i];
            const double before = cpu_ms();
            const FrameStats stats = renderer.render(bench.scene, settings).stats;
            if (round == 0) continue;  // compiles shaders
            times[i].cpu.push_back(cpu_ms() - before);
            if (times[i].wall.empty() || stats.frame_ms < *std::min_element(times[i].wall.begin(), times[i].wall.end()))
                times[i].best = stats;
            times[i].wall.push_back(stats.frame_ms);
        }
    }
    return times;
}

nlohmann::json json_of(const BenchScene& bench, const Times& times) {
    nlohmann::json json{{"scene", bench.name},
                        {"backend", name_of(times.best.backend)},
                        {"surfels", times.best.surfels_drawn},
                        {"triangles", times.best.triangles_drawn},
                        {"covered_pixels", times.best.covered_pixels},
                        {"min_ms", *std::min_element(times.wall.begin(), times.wall.end())},
                        {"median_ms", median(times.wall)},
                        {"cpu_median_ms", median(times.cpu)},
                        {"passes", nlohmann::json::array()}};
    for (const PassTime& pass : times.best.passes)
        json["passes"].push_back({{"name", pass.name}, {"gpu_ms", pass.gpu_ms}});
    return json;
}

}  // namespace

nlohmann::json bench_frame(const std::vector<std::filesystem::path>& models, const FrameBenchOptions& options) {
    Renderer renderer({.device = options.device});
    std::vector<std::function<BenchScene()>> scenes;
    for (const auto& path : models)
        scenes.emplace_back([&renderer, &options, path] { return file_scene(renderer, path, options); });
    if (models.empty())
        for (const std::uint32_t count : {50'000u, 300'000u, 1'000'000u})
            scenes.emplace_back([&renderer, count] { return sphere_scene(renderer, count); });

    nlohmann::json report{{"device", renderer.device_name()},
                          {"width", options.width},
                          {"height", options.height},
                          {"frames", nlohmann::json::array()}};
    Table table(
        {"scene", "backend", "surfels", "min ms", "median ms", "cpu ms", "M surfels/s", "speed-up", "cpu speed-up"});
    for (const auto& make : scenes) {
        const BenchScene bench = make();
        const std::vector<Times> times = measure(renderer, bench, options);
        for (const Times& each : times) {
            const nlohmann::json json = json_of(bench, each);
            const double ms = json["median_ms"].get<double>();
            const auto number = [](double value, int digits) { return fmt::format("{:.{}f}", value, digits); };
            table.add(
                {bench.name, std::string(name_of(each.best.backend)), std::to_string(each.best.surfels_drawn),
                 number(json["min_ms"].get<double>(), 1), number(ms, 1), number(json["cpu_median_ms"].get<double>(), 1),
                 number(static_cast<double>(each.best.surfels_drawn) / ms * 1e-3, 2),
                 number(median(times.front().wall) / ms, 2), number(median(times.front().cpu) / median(each.cpu), 2)});
            report["frames"].push_back(json);
        }
    }
    fmt::print("{}, {}x{}, {} frames each, interleaved\n{}", renderer.device_name(), options.width, options.height,
               options.rounds, table.text());
    return report;
}

}  // namespace splice::bench
