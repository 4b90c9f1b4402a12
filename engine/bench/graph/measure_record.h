// What recording a frame through the graph costs above recording the same commands by hand.
#pragma once

#include "engine/bench/graph/report.h"
#include "engine/vulkan/device.h"

#include <cstdint>

namespace splice::bench {

/// A deferred view of 32 passes with `objects` draws in each pass that writes depth; by hand, through a graph that
/// stays, and through a graph declared anew for each frame, in turn. The commands are executed, too, so every frame
/// starts from the same state. Throws DeviceError.
RecordResult measure_record(gpu::Device& device, uint32_t objects, uint32_t rounds);

}  // namespace splice::bench
