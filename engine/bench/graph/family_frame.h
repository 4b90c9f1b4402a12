// The renderer's own frame among the families: the passes of engine/passes/frame.h and the copy to the host, so five
// passes a view. Declaring it takes a device, because its passes hold shaders and pick formats that the device has.
#pragma once

#include "engine/bench/graph/families.h"
#include "engine/bench/graph/measure_device.h"
#include "engine/vulkan/device.h"

#include <cstdint>

namespace splice::bench {

inline constexpr uint32_t kFrameViewPasses = 5;

/// As many whole views as options.passes holds, at least one. For compiling, not for execution: nothing is drawn.
Family frame_family(gpu::Device& device);

/// One view of a bumpy sphere of 50,000 triangles, baked with the default options.
DeviceWorkload frame_workload(gpu::Device& device, uint32_t width, uint32_t height);

}  // namespace splice::bench
