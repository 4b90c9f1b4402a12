// The report as one page that needs nothing else: drawings inline, no scripts, no network.
#pragma once

#include "engine/bench/graph/report.h"

#include <string>

namespace splice::bench {

/// XHTML, so that any XML parser can check it.
std::string report_html(const GraphReport& report);

}  // namespace splice::bench
