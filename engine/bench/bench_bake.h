// How long the bake takes, stage by stage, how much memory, and how good its choices are.
#pragma once

#include "engine/bench/bench_models.h"

#include <nlohmann/json.hpp>

namespace splice::bench {

struct BakeBenchOptions {
    int runs = 3;                        // medians are taken over these
    std::vector<std::string> arguments;  // passed on to splice-bake
};

/// Runs the program splice-bake that lies beside this one, so that the figures are those of a user, peak memory
/// included; reads its --stats. Prints a table; returns every run's statistics. Throws SystemError when a bake fails.
nlohmann::json bench_bake(const std::vector<BenchModel>& models, const BakeBenchOptions& options);

}  // namespace splice::bench
