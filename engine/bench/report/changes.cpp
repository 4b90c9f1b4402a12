#include "engine/bench/report/changes.h"

#include "engine/bench/table.h"
#include "preprocess/mesh/file_bytes.h"
#include "preprocess/model_format/error.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace splice::bench {
namespace {
using nlohmann::json;

constexpr double kLeastChange = 0.05;  // of a time

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

json json_of(const Sample& sample) {
    return {{"median", sample.median},
            {"minimum", sample.minimum},
            {"lower_quartile", sample.lower_quartile},
            {"upper_quartile", sample.upper_quartile}};
}

void add_time(Figures& figures, const std::string& name, const json& sample, double factor) {
    const auto figure = [&](const char* field) { return sample.at(field).get<double>() * factor; };
    figures[name] = {figure("median"), figure("minimum"), figure("lower_quartile"), figure("upper_quartile"), true};
}

void add_count(Figures& figures, const std::string& name, const json& value) {
    const auto number = value.get<double>();
    figures[name] = {number, number, number, number, false};
}

json read_report_of(const ReportKind& kind, const std::filesystem::path& path) {
    const std::string text = read_file_bytes(path);
    json report;
    try {
        report = json::parse(text);
    } catch (const json::parse_error& error) {
        throw InputError(path.string(), fmt::format("byte {}", error.byte), "not JSON; expected a report of --json");
    }
    const bool ours = report.is_object() && report.contains("benchmark") && report["benchmark"] == kind.name;
    if (!ours) throw InputError(path.string(), "", fmt::format("not a report that {} --json wrote", kind.name));
    if (!report.contains("version") || report["version"] != kind.version)
        throw InputError(path.string(), "/version", fmt::format("expected {}", kind.version));
    return report;
}

std::string change_report(const json& before, const json& now, const std::string& old_name,
                          const std::function<Figures(const json&)>& figures_of,
                          std::initializer_list<const char*> conditions) {
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
    for (const char* field : conditions) {
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
