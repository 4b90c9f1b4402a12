// The command line of `splice-bench graph`.
#pragma once

#include "engine/bench/graph/bench_graph.h"

#include <filesystem>
#include <string>

namespace CLI {
class App;
}

namespace splice::bench {

struct GraphCommand {
    GraphBenchOptions options;
    std::string device = "auto";
    std::filesystem::path json, html, versus;
};

/// Adds the command and its options to the program's; `command` must outlive the parsing.
CLI::App& add_graph_command(CLI::App& program, GraphCommand& command);

/// Measures, prints the tables and writes the files. Throws UsageError, InputError, SystemError, DeviceError.
void run_graph_command(GraphCommand& command);

}  // namespace splice::bench
