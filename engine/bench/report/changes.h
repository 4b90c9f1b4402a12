// What moved between two reports of a benchmark.
#pragma once

#include "engine/bench/report/sample.h"

#include <nlohmann/json.hpp>

#include <filesystem>
#include <functional>
#include <map>
#include <string>

namespace splice::bench {

/// The value of a time is its median. A count has no spread: all four are the same.
struct Figure {
    double value = 0, least = 0, lower = 0, upper = 0;
    bool time = false;
};
using Figures = std::map<std::string, Figure>;

nlohmann::json json_of(const Sample& sample);

/// `sample`: json_of().
void add_time(Figures& figures, const std::string& name, const nlohmann::json& sample, double factor);
void add_count(Figures& figures, const std::string& name, const nlohmann::json& value);

/// Of a benchmark: what "benchmark" and "version" say in its reports.
struct ReportKind {
    const char* name;
    int version;
};

/// A report that the benchmark wrote with --json. Throws InputError for anything else.
nlohmann::json read_report_of(const ReportKind& kind, const std::filesystem::path& path);

/// A table of every time whose quartiles lie apart and whose median and minimum differ by more than 5 %, and of every
/// count that differs, the largest ratios first; then how many figures stayed where they were and what only one of the
/// two has. `conditions`: fields whose change is worth saying. Throws InputError naming `old_name` where `before` lacks
/// a field that `figures_of` looks for.
std::string change_report(const nlohmann::json& before, const nlohmann::json& now, const std::string& old_name,
                          const std::function<Figures(const nlohmann::json&)>& figures_of,
                          std::initializer_list<const char*> conditions);

}  // namespace splice::bench
