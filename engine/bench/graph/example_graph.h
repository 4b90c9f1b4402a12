// One graph taken apart for the drawings.
#pragma once

#include "engine/bench/graph/report.h"
#include "engine/render_graph/graph.h"

#include <string>

namespace splice::bench {

/// Compiles the graph with the sizes of memory_model.h.
ExampleGraph example_graph(const graph::Graph& graph, const std::string& family);

}  // namespace splice::bench
