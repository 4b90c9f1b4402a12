#include "engine/bench/costs_command.h"

#include "engine/bench/report_files.h"
#include "engine/bench/table.h"
#include "engine/capture/calibrate.h"
#include "engine/capture/load_scene.h"
#include "engine/capture/picture_size.h"
#include "engine/capture/stats_json.h"
#include "preprocess/model_format/atomic_file.h"
#include "preprocess/model_format/error.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <array>
#include <tuple>

namespace splice::bench {

namespace {

constexpr std::array kZooms{1.0, 0.3};

struct Row {
    std::string model;
    double zoom;
    CaptureSettings settings;
    FrameStats stats = {};
    std::vector<double> ms = {};
};

std::string table_text(const DrawCosts& costs) {
    return fmt::format(
        ".frame = {:.0f}, .frame_pixel = {:.4f}, .triangle = {:.4f}, .triangle_hit = {:.4f}, .triangle_pixel = {:.4f}, "
        ".splat = {:.4f}, "
        ".splat_pixel = {:.4f}",
        costs.frame, costs.frame_pixel, costs.triangle, costs.triangle_hit, costs.triangle_pixel, costs.splat,
        costs.splat_pixel);
}

std::string samples_text(const Calibration& calibration) {
    Table table({"triangles", "hits", "their pixels", "splats", "their pixels", "picture's pixels", "measured ms",
                 "fitted ms"});
    for (const CostSample& sample : calibration.samples) {
        const DrawLoad& load = sample.load;
        table.add({fmt::format("{:.0f}", load.triangles), fmt::format("{:.0f}", load.triangle_hits),
                   fmt::format("{:.0f}", load.triangle_pixels), fmt::format("{:.0f}", load.splats),
                   fmt::format("{:.0f}", load.splat_pixels), fmt::format("{:.0f}", load.frame_pixels),
                   fmt::format("{:.2f}", sample.ms), fmt::format("{:.2f}", predicted_ms(calibration.costs, load))});
    }
    return table.text();
}

// Frames of a scene in turn, so that whatever else the machine does meets all alike.
std::vector<Row> measure(Renderer& renderer, const std::filesystem::path& file, const CostsCommand& command,
                         const CaptureSettings& settings) {
    const LoadedScene loaded = load_scene(file, renderer);
    std::vector<Row> rows;
    for (const double zoom : kZooms) {
        Row row{file.stem().string(), zoom, settings};
        row.settings.camera = frame_camera(loaded.scene.bounds(), {.zoom = zoom}, settings.width, settings.height);
        for (const double tau : command.taus) {
            rows.push_back(row);
            rows.back().settings.tau = tau;
        }
        for (const double budget : command.budgets) {
            rows.push_back(row);
            rows.back().settings.budget_ms = budget;
        }
    }
    for (unsigned round = 0; round <= command.rounds; ++round)
        for (Row& row : rows) {
            row.stats = renderer.render(loaded.scene, row.settings).stats;
            if (round > 0) row.ms.push_back(row.stats.frame_ms);  // the first compiles shaders
        }
    return rows;
}

}  // namespace

const CLI::App& add_costs_command(CLI::App& app, CostsCommand& command) {
    CLI::App& costs = *app.add_subcommand(
        "costs", "Measures what drawing takes on a device, and how well that predicts frames and holds frame times");
    costs.add_option("FILE", command.files, "Models, scenes or meshes whose frames are predicted")
        ->check(CLI::ExistingFile);
    costs.add_option("--budget", command.budgets, "Milliseconds, separated by commas")
        ->delimiter(',')
        ->check(CLI::Range(0.1, 1e6))
        ->capture_default_str();
    costs.add_option("--tau", command.taus, "Pixels, separated by commas")
        ->delimiter(',')
        ->check(CLI::Range(0.0, kMostTau))
        ->capture_default_str();
    costs.add_option("--rounds", command.rounds, "Timed frames of each")
        ->check(CLI::Range(1U, 10'000U))
        ->capture_default_str();
    costs.add_option("--size", command.size, "Pixels, WIDTHxHEIGHT")->capture_default_str();
    costs.add_option("--backend", command.backend, "As splice-capture's")->capture_default_str();
    costs.add_option("--device", command.device, "auto, cpu, or an index of splice-capture --list-devices")
        ->capture_default_str();
    costs.add_option("--json", command.json, "Write all figures to this file");
    return costs;
}

void run_costs_command(const CostsCommand& command) {
    check_report_files(files_of_scenes("FILE", command.files), {{"--json", command.json}});
    CaptureSettings settings;
    std::tie(settings.width, settings.height) = parse_size(command.size);
    const std::optional<Backend> backend = find_named(kBackendNames, command.backend);
    if (!backend) throw UsageError("--backend: expected one of " + listed(kBackendNames) + ", got " + command.backend);
    settings.backend = *backend;
    Renderer renderer({.device = command.device});
    const Calibration calibration = calibrate(renderer, settings.backend);
    settings.costs = calibration.costs;
    fmt::print("{}, backend {}, microseconds:\n{}\n\n{}", renderer.device_name(), command.backend,
               table_text(calibration.costs), samples_text(calibration));
    nlohmann::json report{{"device", renderer.device_name()}, {"backend", command.backend}};
    report["costs_us"] = costs_json(calibration.costs);
    report["frames"] = nlohmann::json::array();
    Table table({"model", "zoom", "budget ms", "tau", "splats", "triangles", "predicted ms", "measured ms"});
    for (const std::filesystem::path& file : command.files)
        for (const Row& row : measure(renderer, file, command, settings)) {
            const FrameStats& stats = row.stats;
            const double ms = median(row.ms);
            table.add({row.model, fmt::format("{}", row.zoom),
                       row.settings.budget_ms ? fmt::format("{}", *row.settings.budget_ms) : "-",
                       fmt::format("{:.3g}", stats.cut.tau), std::to_string(stats.surfels_drawn),
                       std::to_string(stats.triangles_drawn), fmt::format("{:.1f}", stats.predicted_ms),
                       fmt::format("{:.1f}", ms)});
            report["frames"].push_back({{"model", row.model},
                                        {"zoom", row.zoom},
                                        {"budget_ms", row.settings.budget_ms.value_or(0)},
                                        {"tau", stats.cut.tau},
                                        {"splats", stats.surfels_drawn},
                                        {"triangles", stats.triangles_drawn},
                                        {"predicted_ms", stats.predicted_ms},
                                        {"measured_ms", ms}});
        }
    if (!command.files.empty()) fmt::print("\n{}", table.text());
    if (!command.json.empty())
        write_text_file(command.json, report.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n");
}

}  // namespace splice::bench
