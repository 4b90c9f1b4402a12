// splice-bench levels: what levels of detail save. Of each mesh, frames of all its triangles beside frames of a cut,
// their times and how true they are; and a fixed view of ever more instances, and a near and a far one.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace splice::bench {

struct LevelsCommand {
    std::vector<std::filesystem::path> files;  // meshes
    std::filesystem::path json, pictures;      // empty: none
    std::string device = "auto", size = "512x512";
    double tau = 1;  // pixels
    unsigned rounds = 9;
    std::vector<unsigned> sides{1, 2, 4, 8, 17};  // instances along each side of a square; none: not measured
};

const CLI::App& add_levels_command(CLI::App& app, LevelsCommand& command);

/// Throws UsageError where it would write over what it reads, and what reading, baking and rendering throw.
void run_levels_command(const LevelsCommand& command);

}  // namespace splice::bench
