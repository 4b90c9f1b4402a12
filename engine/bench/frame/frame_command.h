// The command line of `splice-bench frame`.
#pragma once

#include "engine/bench/frame/bench_frame.h"

#include <filesystem>
#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace splice::bench {

struct FrameCommand {
    FrameBenchOptions options;
    std::vector<std::string> sizes = {"512x512"}, backends, shadings = {"surfel"};
    std::filesystem::path json, html, versus;
};

/// Adds the command and its options to the program's; `command` must outlive the parsing.
CLI::App& add_frame_command(CLI::App& program, FrameCommand& command);

/// Measures, prints the tables and writes the files. Throws UsageError, InputError, SystemError, DeviceError.
void run_frame_command(FrameCommand& command);

}  // namespace splice::bench
