// A picture of a frame for Graphviz: `dot -Tsvg`.
#pragma once

#include "engine/render_graph/graph.h"
#include "engine/render_graph/plan.h"

#include <string>

namespace splice::graph {

/// Passes in recorded order, merged ones in one box, culled ones grey with the reason; an edge for each resource that a
/// pass finds as another left it, dashed where it stays in the render pass; barriers before each group. The plan must
/// be of this graph.
std::string to_dot(const Graph& graph, const Plan& plan);

}  // namespace splice::graph
