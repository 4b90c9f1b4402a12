// splice-bench confetti: tables 1 and 2 of Pajarola et al. 2004, measured again, the published figures beside them.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace splice::bench {

struct ConfettiCommand {
    std::vector<std::filesystem::path> files;  // point clouds, or meshes whose vertices are taken
    std::filesystem::path folder;              // of the models that are measured without `files`
    std::filesystem::path json;                // empty: none
    std::string device = "auto";
    std::string kernel = "confetti:6,1.5,3";
    unsigned frames = 24;  // a full turn each
};

const CLI::App& add_confetti_command(CLI::App& app, ConfettiCommand& command);

/// Throws what reading, baking and rendering throw.
void run_confetti_command(const ConfettiCommand& command);

}  // namespace splice::bench
