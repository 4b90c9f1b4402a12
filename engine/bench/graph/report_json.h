// The report as JSON; docs/render_graph.md describes the fields.
#pragma once

#include "engine/bench/graph/report.h"

#include <nlohmann/json.hpp>

namespace splice::bench {

/// What "benchmark" says in a report of `splice-bench graph`.
inline constexpr const char* kReportKind = "splice-bench graph";
inline constexpr int kReportVersion = 2;

nlohmann::json to_json(const GraphReport& report);

}  // namespace splice::bench
