// A frame as text: Graphviz (`dot -Tsvg`), Mermaid (drawn by the viewers of Markdown) and JSON (everything, for
// programs). Of the declaration alone, or with what compile() made of it.
#pragma once

#include "engine/render_graph/graph.h"
#include "engine/render_graph/plan.h"

#include <optional>
#include <string>
#include <string_view>

namespace splice::graph {

enum class ExportFormat { dot, mermaid, json };

/// By the extension of a file's name: ".dot", ".mmd", ".json".
std::optional<ExportFormat> export_format_of(std::string_view file_name);

/// Passes and an edge for each resource that a pass finds as another left it. With a plan, which must be of this graph:
/// passes in recorded order, merged ones in one box, culled ones grey with the reason; barriers before each group;
/// edges dashed where the resource stays in a render pass.
std::string export_graph(const Graph& graph, ExportFormat format);
std::string export_graph(const Graph& graph, const Plan& plan, ExportFormat format);

}  // namespace splice::graph
