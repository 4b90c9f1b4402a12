// `splice-bench graph`: everything of one run.
#pragma once

#include "engine/bench/graph/report.h"
#include "engine/vulkan/device_list.h"

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace splice::bench {

/// As --families names them: those of families.h, then "frame", which takes a device.
std::vector<std::string> family_names();

struct GraphBenchOptions {
    std::vector<std::string> families;  ///< empty: all
    std::vector<uint32_t> sizes = {4, 16, 64, 256, 1024, 4096};
    uint64_t seed = 1;
    uint32_t repeat = 15;      ///< rounds of compilations, and of frames on the device
    bool use_device = true;    ///< else nothing is run, and "frame" is left out
    gpu::DeviceChoice device;  ///< where used
    std::function<void(std::string_view)> progress = [](std::string_view) {};
};

/// Throws UsageError (no such family, sizes below 4, "frame" alone without a device) and DeviceError.
GraphReport bench_graph(const GraphBenchOptions& options);

}  // namespace splice::bench
