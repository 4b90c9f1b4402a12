#include "engine/bench/cloud_command.h"

#include "engine/bench/run_bake.h"
#include "engine/bench/scan_cloud.h"
#include "engine/bench/table.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <array>

namespace splice::bench {
namespace {

constexpr std::array kStages{"read", "sort", "surface", "orient", "assemble", "write", "total"};

std::vector<std::string> row_of(const std::filesystem::path& file, const CloudCommand& command) {
    std::vector<std::string> arguments;
    if (command.threads > 0) arguments = {"--threads", std::to_string(command.threads)};
    std::vector<BakeRun> runs;
    for (int i = 0; i < command.runs; ++i)
        runs.push_back(run_bake(file, arguments));
    const auto median_of = [&](const auto& figure) {
        std::vector<double> values;
        for (const BakeRun& run : runs)
            values.push_back(figure(run));
        return median(std::move(values));
    };
    const auto at = [&](const char* path) {
        return median_of(
            [&](const BakeRun& run) { return run.stats.at(nlohmann::json::json_pointer(path)).get<double>(); });
    };
    const double points = at("/output/surfels");
    std::vector<std::string> row{file.filename().string(), fmt::format("{:.0f}", points)};
    for (const char* stage : kStages)
        row.push_back(fmt::format("{:.2f}", at((std::string("/seconds/") + stage).c_str())));
    row.push_back(fmt::format("{:.2f}", median_of([](const BakeRun& run) { return run.processor_seconds; })));
    row.push_back(fmt::format("{:.2f}", points / at("/seconds/total") / 1e6));
    row.push_back(fmt::format("{:.0f}", at("/peak_rss_bytes") / points));
    row.push_back(fmt::format("{:.1f}", at("/output/file_bytes") / points));
    return row;
}

}  // namespace

const CLI::App& add_cloud_command(CLI::App& app, CloudCommand& command) {
    CLI::App& cloud = *app.add_subcommand("cloud", "Seconds a stage, memory and file size of baking point clouds");
    cloud.add_option("CLOUD", command.files, "Point clouds; without any: made-up airborne scans");
    cloud.add_option("--points", command.points, "Points of the made-up scans, 1 to 200,000,000")
        ->check(CLI::Range(1u, 200'000'000u))
        ->capture_default_str();
    cloud.add_option("--runs", command.runs, "Medians are taken over this many bakes, 1 to 1000")
        ->check(CLI::Range(1, 1000))
        ->capture_default_str();
    cloud.add_option("--threads", command.threads, "Threads of each bake; 0: one a core")
        ->check(CLI::Range(0, 1024))
        ->capture_default_str();
    return cloud;
}

void run_cloud_command(const CloudCommand& command) {
    std::vector<std::string> header{"seconds", "points"};
    header.insert(header.end(), kStages.begin(), kStages.end());
    header.insert(header.end(), {"processor", "Mpoints/s", "memory B/pt", "file B/pt"});
    Table table(header);
    for (const std::filesystem::path& file : command.files)
        table.add(row_of(file, command));
    if (command.files.empty()) {
        const ScratchFolder scratch;
        for (const std::uint32_t points : command.points) {
            const std::filesystem::path file = scratch.path() / fmt::format("scan{}.las", points);
            write_scan_cloud(file, points);
            table.add(row_of(file, command));
            std::filesystem::remove(file);
        }
    }
    fmt::print("{}", table.text());
}

}  // namespace splice::bench
