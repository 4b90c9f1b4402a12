#include "engine/bench/graph/compare.h"

#include "engine/bench/graph/report_json.h"
#include "engine/bench/report/changes.h"

#include <fmt/format.h>

#include <algorithm>

namespace splice::bench {
namespace {
using nlohmann::json;

std::string graph_name(const json& row) {
    return fmt::format("{} {}", row.at("family").get<std::string>(), row.at("passes").get<uint64_t>());
}

Figures figures_of(const json& report) {
    Figures figures;
    for (const json& row : report.at("compile")) {
        const std::string name = graph_name(row);
        const double passes = std::max(row.at("passes").get<double>(), 1.0);
        add_time(figures, name + ": compile, ns a pass", row.at("compile_ns"), 1 / passes);
        add_time(figures, name + ": declare, ns a pass", row.at("declare_ns"), 1 / passes);
        add_time(figures, name + ": cache hit, us", row.at("cache_hit_ns"), 1e-3);
        for (const json& phase : row.at("phases"))
            add_time(figures, fmt::format("{}: phase {}, ns a pass", name, phase.at("name").get<std::string>()),
                     phase.at("ns"), 1 / passes);
        for (const char* count : {"groups", "merged_passes", "culled", "barriers", "barrier_commands"})
            add_count(figures, fmt::format("{}: {}", name, count), row.at(count));
    }
    for (const json& row : report.at("memory"))
        add_count(figures, graph_name(row) + ": placed bytes", row.at("placed_bytes"));
    for (const json& row : report.at("on_device")) {
        for (const json& variant : row.at("variants")) {
            const std::string name = fmt::format("{}, {}", graph_name(row), variant.at("name").get<std::string>());
            add_time(figures, name + ": frame, ms", variant.at("frame_ms"), 1);
            add_time(figures, name + ": record, us", variant.at("record_us"), 1);
            add_count(figures, name + ": transient bytes", variant.at("transient_bytes"));
        }
    }
    for (const json& row : report.at("record_growth")) {
        add_time(figures, graph_name(row) + ": record empty, us", row.at("record_us"), 1);
        add_time(figures, graph_name(row) + ": hit, us", row.at("hit_us"), 1);
    }
    for (const json& row : report.at("record")) {
        const std::string name = fmt::format("record, {} objects", row.at("objects").get<uint64_t>());
        for (const char* way : {"by_hand_us", "through_graph_us", "declared_anew_us"})
            add_time(figures, fmt::format("{}: {}", name, way), row.at(way), 1);
    }
    return figures;
}

}  // namespace

json read_report(const std::filesystem::path& path) {
    return read_report_of({kReportKind, kReportVersion}, path);
}

std::string compare_reports(const json& before, const json& now, const std::string& old_name) {
    return change_report(before, now, old_name, figures_of, {"seed", "processor", "device"});
}

}  // namespace splice::bench
