// The report as tables for people.
#pragma once

#include "engine/bench/graph/report.h"

#include <cstdint>
#include <string>
#include <vector>

namespace splice::bench {

std::string report_text(const GraphReport& report);

/// The size that tables of one size show: 1,024 passes or what comes nearest below; per family, in order.
std::vector<const CompileResult*> typical_results(const GraphReport& report);

}  // namespace splice::bench
