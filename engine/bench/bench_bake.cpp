#include "engine/bench/bench_bake.h"

#include "engine/bench/run_bake.h"
#include "engine/bench/table.h"

#include <fmt/format.h>
#include <unistd.h>

#include <array>
#include <cstdio>

namespace splice::bench {
namespace {
using nlohmann::json;

constexpr std::array kStages{"read",   "repair", "cluster",  "judge", "simplify",
                             "sample", "prune",  "assemble", "write", "total"};

double median_of(const std::vector<json>& runs, const json::json_pointer& figure) {
    std::vector<double> values;
    for (const json& run : runs)
        values.push_back(run.at(figure).get<double>());
    return median(std::move(values));
}

/// Null where nothing is surfels.
std::string figure_or_dash(const json& figure, int digits) {
    return figure.is_null() ? "-" : fmt::format("{:.{}f}", figure.get<double>(), digits);
}

}  // namespace

json bench_bake(const std::vector<BenchModel>& models, const BakeBenchOptions& options) {
    json report = json::array();
    std::vector<std::string> header{"seconds"};
    for (const char* stage : kStages)
        header.emplace_back(stage);
    header.insert(header.end(), {"thesis", "cluster ktri/s", "MB", "MB allowed"});
    Table times(header);
    Table results({"results", "triangles", "kept %", "thesis %", "patches t/s", "auc", "surfels", "thesis/ours",
                   "coverage", "file MB"});
    for (const BenchModel& model : models) {
        std::vector<json> runs;
        for (int i = 0; i < options.runs; ++i) {
            if (isatty(STDERR_FILENO)) fmt::print(stderr, "\r\033[Kbake {} {}/{}", model.name, i + 1, options.runs);
            runs.push_back(run_bake(model.path, options.arguments).stats);
        }
        if (isatty(STDERR_FILENO)) fmt::print(stderr, "\r\033[K");

        std::vector<std::string> row{model.name};
        json seconds;
        for (const char* stage : kStages) {
            const double value = median_of(runs, json::json_pointer("/seconds") / stage);
            seconds[stage] = value;
            row.push_back(fmt::format("{:.3f}", value));
        }
        const json& last = runs.back();
        const auto in = last.at("/repair/triangles"_json_pointer).get<double>();
        const auto kept = last.at("/output/triangles"_json_pointer).get<double>();
        const auto surfels = last.at("/output/surfels"_json_pointer).get<double>();
        const double memory = median_of(runs, "/peak_rss_bytes"_json_pointer);
        const double cluster_rate = in / seconds["cluster"].get<double>();
        row.push_back(model.published ? fmt::format("{:.0f}", model.published->bake_seconds) : "");
        row.push_back(fmt::format("{:.0f}", cluster_rate / 1e3));
        row.push_back(fmt::format("{:.0f}", memory / 1e6));
        row.push_back(fmt::format("{:.0f}", 64 + in / 1e3));
        times.add(row);
        results.add({model.name, fmt::format("{:.0f}", in), fmt::format("{:.1f}", 100 * kept / in),
                     model.published
                         ? fmt::format("{:.1f}", 100 * model.published->triangles_kept / model.published->triangles_in)
                         : "",
                     fmt::format("{}/{}", last.at("/patches/triangle"_json_pointer).get<std::uint64_t>(),
                                 last.at("/patches/surfel"_json_pointer).get<std::uint64_t>()),
                     figure_or_dash(last.at("/selection/auc"_json_pointer), 3), fmt::format("{:.0f}", surfels),
                     model.published && surfels > 0 ? fmt::format("{:.1f}", model.published->surfels / surfels) : "",
                     figure_or_dash(last.at("/output/coverage_mean"_json_pointer), 2),
                     fmt::format("{:.1f}", last.at("/output/file_bytes"_json_pointer).get<double>() / 1e6)});
        report.push_back({{"model", model.name},
                          {"median_seconds", seconds},
                          {"cluster_triangles_per_second", cluster_rate},
                          {"median_peak_rss_bytes", memory},
                          {"runs", runs}});
    }
    fmt::print("{}\n{}", times.text(), results.text());
    return report;
}

}  // namespace splice::bench
