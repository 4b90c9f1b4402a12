// The switches of the render graph as splice-capture's --graph-switch names them.
#pragma once

#include "engine/render_graph/executor/executor.h"

#include <string>

namespace splice {

/// "no-cull,random-order=7": each changes what the frame costs and never the picture. Throws UsageError.
void apply_graph_switches(const std::string& list, graph::ExecutorOptions& options);

/// Their names, for --help.
std::string graph_switch_help();

}  // namespace splice
