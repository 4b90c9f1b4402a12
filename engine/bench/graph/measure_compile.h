// Compile times, barriers and bytes of the families: no device at work.
#pragma once

#include "engine/bench/graph/families.h"
#include "engine/bench/graph/report.h"

#include <functional>
#include <string_view>
#include <vector>

namespace splice::bench {

struct CompileMeasurement {
    std::vector<Family> families;
    std::vector<uint32_t> sizes;  ///< passes
    uint64_t seed = 1;
    uint32_t repeat = 15;
    uint32_t memory_seeds = 5;  ///< seed, seed + 1, ...
    std::function<void(std::string_view)> progress = [](std::string_view) {};
};

/// Each round declares, compiles and looks up every graph once, one after the other, so that every graph finds the
/// caches as another one left them and a disturbance hits all alike.
std::vector<CompileResult> measure_compile(const CompileMeasurement& measurement);

/// One a family with two sizes or more between 64 and 4,096 passes.
std::vector<Growth> fit_growth(const std::vector<CompileResult>& results);

std::vector<MemoryResult> measure_memory(const CompileMeasurement& measurement);

}  // namespace splice::bench
