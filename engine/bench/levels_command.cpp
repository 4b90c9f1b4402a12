#include "engine/bench/levels_command.h"

#include "engine/bench/bench_view.h"
#include "engine/bench/report_files.h"
#include "engine/bench/table.h"
#include "engine/capture/capture.h"
#include "engine/capture/picture_size.h"
#include "engine/capture/stats_json.h"
#include "engine/scene/gpu_model.h"
#include "preprocess/model_format/atomic_file.h"
#include "tests/reference/comparison.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>

namespace splice::bench {

namespace {

using namespace splice::reference;

// Shares of the picture that the near and the far view cover.
constexpr double kNear = 0.46, kFar = 0.13;

struct Timed {
    const Scene* scene;
    CaptureSettings settings;
    Frame frame = {};
    std::vector<double> ms = {};
};

// Frames in turn, so that whatever else the machine does meets all alike. The first of each compiles shaders.
void measure(Renderer& renderer, std::vector<Timed>& all, unsigned rounds) {
    for (unsigned round = 0; round <= rounds; ++round)
        for (Timed& each : all) {
            each.frame = renderer.render(*each.scene, each.settings);
            if (round > 0) each.ms.push_back(each.frame.stats.frame_ms);
        }
}

nlohmann::json json_of(const Timed& timed) {
    const FrameStats& stats = timed.frame.stats;
    return {{"ms", median(timed.ms)},
            {"tau", stats.cut.tau},
            {"splats", stats.surfels_drawn},
            {"triangles", stats.triangles_drawn},
            {"select_ms", stats.cut.select_ms},
            {"gather_ms", stats.cut.gather_ms},
            {"covered_pixels", stats.covered_pixels},
            {"nodes_visited", stats.cut.counts.visited}};
}

double coverage_of(const Frame& frame) {
    return static_cast<double>(frame.stats.covered_pixels) / (static_cast<double>(frame.width) * frame.height);
}

// A zoom at which the scene covers so much of the picture.
double zoom_that_covers(Renderer& renderer, const Scene& scene, CaptureSettings settings, double share) {
    double zoom = 1;
    for (int i = 0; i < 6; ++i) {
        settings.camera = frame_camera(scene.bounds(), {.zoom = zoom}, settings.width, settings.height);
        zoom *= std::sqrt(share / std::max(coverage_of(renderer.render(scene, settings)), 1e-3));
    }
    return zoom;
}

Scene square_of(const std::shared_ptr<const GpuModel>& model, unsigned side) {
    const glm::dvec3 size = model->bounds().maximum - model->bounds().minimum;
    Scene scene = scene_of(model);
    scene.instances.clear();
    for (unsigned y = 0; y < side; ++y)
        for (unsigned x = 0; x < side; ++x)
            scene.instances.push_back({model, {.translation = size * glm::dvec3(x, y, 0)}});
    return scene;
}

class Bench {
  public:
    explicit Bench(const LevelsCommand& command)
        : command_(command), renderer_({command.device, false}), report_{{"device", renderer_.device_name()}} {
        std::tie(settings_.width, settings_.height) = parse_size(command.size);
        settings_.backend = Backend::kTile;
    }

    void run(const std::filesystem::path& file) {
        name_ = file.stem().stem().string();
        show_progress("bake " + name_);
        mesh_ = load_mesh(file);
        const BakedModel baked = bake_for(renderer_, mesh_, {});
        show_progress("draw " + name_);
        against_triangles(baked);
        if (!command_.sides.empty()) flatness(baked);
        show_progress("");
    }

    void print() const {
        fmt::print("{}, {}x{}, tau {}\n\n{}\n", renderer_.device_name(), settings_.width, settings_.height,
                   command_.tau, triangles_table_.text());
        if (!command_.sides.empty()) fmt::print("{}\n{}\n", flat_table_.text(), far_table_.text());
    }

    const nlohmann::json& report() const { return report_; }

  private:
    CaptureSettings cut_settings(const Scene& scene, double zoom) const {
        CaptureSettings settings = settings_;
        settings.camera = frame_camera(scene.bounds(), {.zoom = zoom}, settings.width, settings.height);
        settings.tau = command_.tau;
        return settings;
    }

    void against_triangles(const BakedModel& baked) {
        const Scene scene = scene_of(baked.on_device);
        CaptureSettings cut = cut_settings(scene, 1), triangles = cut, full = cut;
        triangles.shown = Shown::kTriangles;
        triangles.tau = full.tau = 0;
        CaptureSettings cut_4 = cut, triangles_4 = triangles;
        cut_4.antialias = triangles_4.antialias = 2;
        std::vector<Timed> all{
            {&scene, triangles}, {&scene, full}, {&scene, cut}, {&scene, cut_4}, {&scene, triangles_4}};
        measure(renderer_, all, command_.rounds);
        const ReferenceScene oracle(mesh_);
        const Truth truth = truth_of(oracle, mesh_, scene, cut.camera, cut.width, cut.height,
                                     (baked.model.info.flags & format::kTwoSided) != 0);
        const std::array<const char*, 5> what{"all triangles", "full detail", "cut", "cut, 4 samples",
                                              "all triangles, 4 samples"};
        for (std::size_t i = 0; i < all.size(); ++i) {
            const FrameStats& stats = all[i].frame.stats;
            const Agreement found = compare(all[i].frame, truth);
            const double ms = median(all[i].ms);
            triangles_table_.add({name_, what[i], fmt::format("{:.1f}", ms),
                                  fmt::format("{:.2f}", median(all[0].ms) / ms), fmt::format("{:.2f}", found.inside_db),
                                  fmt::format("{:.2f}", found.frame_db), std::to_string(stats.triangles_drawn),
                                  std::to_string(stats.surfels_drawn), fmt::format("{:.1f}", stats.cut.select_ms),
                                  fmt::format("{:.1f}", stats.cut.gather_ms)});
            nlohmann::json row = json_of(all[i]);
            row.update(
                {{"model", name_}, {"drawn", what[i]}, {"inside_db", found.inside_db}, {"frame_db", found.frame_db}});
            report_["triangles"].push_back(row);
            if (!command_.pictures.empty()) {
                std::filesystem::create_directories(command_.pictures);
                write_png(command_.pictures / fmt::format("{}-{}.png", name_, i), colours(all[i].frame));
            }
        }
        if (!command_.pictures.empty()) write_png(command_.pictures / (name_ + "-reference.png"), truth.image);
    }

    void flatness(const BakedModel& baked) {
        std::vector<Scene> scenes;
        for (const unsigned side : command_.sides)
            scenes.push_back(square_of(baked.on_device, side));
        std::vector<Timed> all;
        for (const Scene& scene : scenes)
            all.push_back({&scene, cut_settings(scene, 1)});
        const double near = zoom_that_covers(renderer_, scenes.front(), all.front().settings, kNear);
        const double far = near * std::sqrt(kFar / kNear);
        for (const double zoom : {near, far})
            all.push_back({&scenes.front(), cut_settings(scenes.front(), zoom)});
        measure(renderer_, all, command_.rounds);
        for (std::size_t i = 0; i < all.size(); ++i) {
            const FrameStats& stats = all[i].frame.stats;
            const double ms = median(all[i].ms);
            nlohmann::json row = json_of(all[i]);
            row["model"] = name_;
            const bool instanced = i < scenes.size();
            const std::uint64_t surfels = baked.on_device->surfel_count() * all[i].scene->instances.size();
            const double first = median(all[instanced ? 0 : scenes.size()].ms);
            row["surfels"] = surfels;
            report_[instanced ? "instances" : "views"].push_back(row);
            (instanced ? flat_table_ : far_table_)
                .add({name_,
                      instanced ? fmt::format("{:.1f} M", static_cast<double>(surfels) * 1e-6)
                                : fmt::format("{:.0f} %", 100 * coverage_of(all[i].frame)),
                      fmt::format("{:.1f}", ms), fmt::format("{:.2f}", ms / first),
                      std::to_string(stats.triangles_drawn), std::to_string(stats.surfels_drawn),
                      fmt::format("{:.1f}", stats.cut.select_ms), std::to_string(stats.cut.counts.visited)});
        }
    }

    const LevelsCommand& command_;
    Renderer renderer_;
    CaptureSettings settings_;
    IndexedMesh mesh_;
    std::string name_;
    Table triangles_table_{{"model", "drawn", "ms", "times as fast", "inside dB", "frame dB", "triangles", "splats",
                            "select ms", "gather ms"}};
    Table flat_table_{
        {"instances of", "surfels", "ms", "times the first", "triangles", "splats", "select ms", "nodes"}};
    Table far_table_{{"view of", "coverage", "ms", "times the first", "triangles", "splats", "select ms", "nodes"}};
    nlohmann::json report_;
};

}  // namespace

const CLI::App& add_levels_command(CLI::App& app, LevelsCommand& command) {
    CLI::App& levels = *app.add_subcommand(
        "levels", "Frames of a cut beside all triangles, of ever more instances, from near and far");
    levels.add_option("MESH", command.files, "Meshes")->required()->check(CLI::ExistingFile);
    levels.add_option("--tau", command.tau, "Pixels, of the cuts, 0 to 1000")
        ->check(CLI::Range(0.0, 1000.0))
        ->capture_default_str();
    levels.add_option("--instances", command.sides, "Instances along each side of a square; a list; 0: none")
        ->delimiter(',')
        ->check(CLI::Range(0U, 100U))
        ->capture_default_str();
    levels.add_option("--rounds", command.rounds, "Timed frames of each")
        ->check(CLI::Range(1U, 10'000U))
        ->capture_default_str();
    levels.add_option("--size", command.size, "Pixels, WIDTHxHEIGHT")->capture_default_str();
    levels.add_option("--device", command.device, "auto, cpu, or an index of splice-capture --list-devices")
        ->capture_default_str();
    levels.add_option("--pictures", command.pictures, "Write frames and references to this folder");
    levels.add_option("--json", command.json, "Write all figures to this file");
    return levels;
}

void run_levels_command(const LevelsCommand& command) {
    check_report_files(named_files("MESH", command.files), {{"--json", command.json}});
    LevelsCommand own = command;
    std::erase(own.sides, 0U);
    Bench bench(own);
    for (const std::filesystem::path& file : command.files)
        bench.run(file);
    bench.print();
    if (!command.json.empty())
        write_text_file(command.json,
                        bench.report().dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n");
}

}  // namespace splice::bench
