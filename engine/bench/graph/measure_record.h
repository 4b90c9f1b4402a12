// What recording a frame through the graph costs above recording the same commands by hand.
#pragma once

#include "engine/bench/graph/families.h"
#include "engine/bench/graph/report.h"
#include "engine/vulkan/device.h"

#include <cstdint>
#include <functional>
#include <string_view>
#include <vector>

namespace splice::bench {

/// A deferred view of 32 passes with `objects` draws in each pass that writes depth; by hand, through a graph that
/// stays, and through a graph declared anew for each frame, in turn. The commands are executed, too, so every frame
/// starts from the same state. Throws DeviceError.
RecordResult measure_record(gpu::Device& device, uint32_t objects, uint32_t rounds);

struct RecordGrowthMeasurement {
    std::vector<Family> families;
    std::vector<uint32_t> sizes;  ///< passes
    uint64_t seed = 1;
    uint32_t rounds = 15;
    std::function<void(std::string_view)> progress = [](std::string_view) {};
};

/// Images are of at most 64 x 64 pixels; the commands are executed. Each graph is measured on its own. Throws
/// DeviceError.
std::vector<RecordGrowthResult> measure_record_growth(gpu::Device& device, const RecordGrowthMeasurement& measurement);

}  // namespace splice::bench
