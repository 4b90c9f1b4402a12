// Whole frames on a device under different switches of the compiler.
#pragma once

#include "engine/bench/graph/families.h"
#include "engine/bench/graph/report.h"
#include "engine/render_graph/executor/executor.h"
#include "engine/vulkan/device.h"

#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace splice::bench {

/// A frame to be run, and what it is called.
struct DeviceWorkload {
    std::string family;
    uint32_t passes = 0, width = 0, height = 0;
    /// Makes one more declaring function, with drawing objects of its own.
    std::function<std::function<void(graph::Graph&)>()> make;
};

/// Frames of the family whose passes draw; images of random size have up to width x height pixels in all.
DeviceWorkload painted_workload(gpu::Device& device, const Family& family, uint32_t passes, uint32_t width,
                                uint32_t height, uint64_t seed);

/// One round runs every variant once, so that a disturbance hits all alike. Throws DeviceError.
DeviceResult measure_device(gpu::Device& device, const DeviceWorkload& workload, uint32_t rounds,
                            const std::function<void(std::string_view)>& progress);

}  // namespace splice::bench
