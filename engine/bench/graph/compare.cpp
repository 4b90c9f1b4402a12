#include "engine/bench/graph/compare.h"

#include "engine/bench/graph/report_json.h"
#include "engine/bench/table.h"
#include "preprocess/mesh/file_bytes.h"
#include "preprocess/model_format/error.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <vector>

namespace splice::bench {
namespace {
using nlohmann::json;

constexpr double kLeastChange = 0.05;  // of a time

/// The value of a time is its median. A count has no spread: all four are the same.
struct Figure {
    double value = 0, least = 0, lower = 0, upper = 0;
    bool time = false;
};
using Figures = std::map<std::string, Figure>;

void add_time(Figures& figures, const std::string& name, const json& sample, double factor) {
    const auto figure = [&](const char* field) { return sample.at(field).get<double>() * factor; };
    figures[name] = {figure("median"), figure("minimum"), figure("lower_quartile"), figure("upper_quartile"), true};
}

void add_count(Figures& figures, const std::string& name, const json& value) {
    const auto number = value.get<double>();
    figures[name] = {number, number, number, number, false};
}

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

/// A time has moved when the quartiles lie apart, and median and minimum have moved alike: a machine that was busy
/// shifts the median more than the minimum.
bool moved(const Figure& before, const Figure& now) {
    if (!now.time) return before.value != now.value;
    const bool slower = now.lower > before.upper && now.value > before.value * (1 + kLeastChange) &&
                        now.least > before.least * (1 + kLeastChange);
    const bool faster = now.upper < before.lower && now.value < before.value * (1 - kLeastChange) &&
                        now.least < before.least * (1 - kLeastChange);
    return slower || faster;
}

std::string number(double value) {
    return std::abs(value) >= 100 ? fmt::format("{:.0f}", value) : fmt::format("{:.3g}", value);
}

struct Change {
    std::string name;
    Figure before, now;
    double ratio() const { return now.value / before.value; }
    /// How far from 1 the ratio is, in either direction; from or to nothing is farthest.
    double distance() const { return std::abs(std::log(ratio())); }
};

std::string change_table(const std::vector<Change>& changes) {
    Table table({"what moved", "before", "now", "ratio", ""});
    for (const Change& change : changes) {
        const char* word = change.now.value < change.before.value ? "less" : "more";
        if (change.now.time) word = change.now.value < change.before.value ? "faster" : "slower";
        table.add({change.name, number(change.before.value), number(change.now.value),
                   change.before.value == 0 ? "" : fmt::format("{:.2f}", change.ratio()), word});
    }
    return table.text();
}

}  // namespace

json read_report(const std::filesystem::path& path) {
    const std::string text = read_file_bytes(path);
    json report;
    try {
        report = json::parse(text);
    } catch (const json::parse_error& error) {
        throw InputError(path.string(), fmt::format("byte {}", error.byte), "not JSON; expected a report of --json");
    }
    const bool ours = report.is_object() && report.contains("benchmark") && report["benchmark"] == kReportKind;
    if (!ours) throw InputError(path.string(), "", "not a report that splice-bench graph --json wrote");
    if (!report.contains("version") || report["version"] != kReportVersion)
        throw InputError(path.string(), "/version", fmt::format("expected {}", kReportVersion));
    return report;
}

std::string compare_reports(const json& before, const json& now, const std::string& old_name) {
    Figures old_figures;
    try {
        old_figures = figures_of(before);
    } catch (const json::exception& error) {
        throw InputError(old_name, "", fmt::format("a field is missing or has another type: {}", error.what()));
    }
    const Figures new_figures = figures_of(now);
    std::vector<Change> changes;
    std::vector<double> ratios;  // of all times
    size_t common = 0;
    for (const auto& [name, figure] : new_figures) {
        const auto found = old_figures.find(name);
        if (found == old_figures.end()) continue;
        ++common;
        if (figure.time && found->second.value > 0) ratios.push_back(figure.value / found->second.value);
        if (moved(found->second, figure)) changes.push_back({name, found->second, figure});
    }
    std::stable_sort(changes.begin(), changes.end(),
                     [](const Change& a, const Change& b) { return a.distance() > b.distance(); });
    std::string text;
    for (const char* field : {"seed", "processor", "device"}) {
        if (before.value(field, json()) != now.value(field, json()))
            text += fmt::format("{}: {} before, {} now\n", field, before.value(field, json()).dump(),
                                now.value(field, json()).dump());
    }
    if (!changes.empty()) text += change_table(changes);
    if (!ratios.empty())
        text += fmt::format("all times: {:.2f} of before, in the median; far from 1, it may be the machine\n",
                            median(ratios));
    text += fmt::format("{} of {} figures moved; the others are the same or within the spread of the measurements\n",
                        changes.size(), common);
    const size_t only_before = old_figures.size() - common, only_now = new_figures.size() - common;
    if (only_before + only_now > 0)
        text +=
            fmt::format("not compared: {} figures only in {}, {} only measured now\n", only_before, old_name, only_now);
    return text;
}

}  // namespace splice::bench
