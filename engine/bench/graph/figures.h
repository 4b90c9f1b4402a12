// The drawings of the report, each one SVG.
#pragma once

#include "engine/bench/graph/report.h"

#include <string>

namespace splice::bench {

/// Compile time a pass over the number of passes, both axes logarithmic, one line a family.
std::string draw_growth(const GraphReport& report);
/// What each phase takes of it at one size, one bar a family.
std::string draw_phases(const GraphReport& report);
/// Barriers of the plan beside one an access.
std::string draw_barriers(const GraphReport& report);
/// Worst placed bytes over the lower bound, a family and size.
std::string draw_memory(const GraphReport& report);
/// Offsets in the heap against groups, one rectangle a resource.
std::string draw_lifetimes(const ExampleGraph& example);
/// The passes in the layers of their dependencies; a box around those that share a render pass.
std::string draw_graph(const ExampleGraph& example);

}  // namespace splice::bench
