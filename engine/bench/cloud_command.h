// splice-bench cloud: how fast point clouds bake, stage by stage, and how large they become.
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

namespace CLI {
class App;
}

namespace splice::bench {

struct CloudCommand {
    std::vector<std::filesystem::path> files;      // point clouds
    std::vector<std::uint32_t> points{2'000'000};  // of made-up scans (scan_cloud.h), without `files`
    int runs = 3;                                  // medians are taken over these
    int threads = 0;                               // 0: one a core
};

const CLI::App& add_cloud_command(CLI::App& app, CloudCommand& command);

/// Throws what writing, reading and baking throw.
void run_cloud_command(const CloudCommand& command);

}  // namespace splice::bench
