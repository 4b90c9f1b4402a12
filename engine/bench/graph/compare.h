// What moved between two reports.
#pragma once

#include <nlohmann/json.hpp>

#include <filesystem>
#include <string>

namespace splice::bench {

/// A report that `splice-bench graph --json` wrote. Throws InputError for anything else.
nlohmann::json read_report(const std::filesystem::path& path);

/// See change_report() of report/changes.h. Throws InputError naming `old_name` where `before` lacks a field.
std::string compare_reports(const nlohmann::json& before, const nlohmann::json& now, const std::string& old_name);

}  // namespace splice::bench
