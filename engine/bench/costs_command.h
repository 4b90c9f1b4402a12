// splice-bench costs: what drawing takes on a device (engine/scene/draw_costs.h), how well that predicts frames, and
// how long frames take that are to take so long.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace splice::bench {

struct CostsCommand {
    std::vector<std::filesystem::path> files;  // models, scenes or meshes
    std::filesystem::path json;                // empty: none
    std::string device = "auto", backend = "auto", size = "512x512";
    std::vector<double> budgets{10, 20, 40};  // milliseconds
    std::vector<double> taus{0, 1, 2, 4};     // pixels
    unsigned rounds = 7;
};

const CLI::App& add_costs_command(CLI::App& app, CostsCommand& command);

/// Throws what reading, baking and rendering throw.
void run_costs_command(const CostsCommand& command);

}  // namespace splice::bench
