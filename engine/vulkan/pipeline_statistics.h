// What the stages of the pipeline did, counted by the device.
#pragma once

#include "engine/vulkan/device.h"
#include "engine/vulkan/handle.h"

#include <vulkan/vulkan_core.h>

#include <cstdint>
#include <vector>

namespace splice::gpu {

/// Of drawing alone. Invocations of compute shaders follow from the size of a dispatch, and lavapipe (22.3) crashes
/// where they are counted and no compute pipeline is bound.
struct PipelineCounts {
    uint64_t input_vertices = 0;        ///< read by the input assembly
    uint64_t vertex_invocations = 0;    ///< of vertex shaders
    uint64_t clipped_primitives = 0;    ///< that clipping let through
    uint64_t fragment_invocations = 0;  ///< of fragment shaders
};

class PipelineStatistics {
  public:
    PipelineStatistics() = default;
    /// Throws DeviceError where DeviceFeatures::pipeline_statistics is off.
    PipelineStatistics(const Device& device, uint32_t capacity);

    /// Outside of a render pass, before the first begin() of a frame.
    void reset(VkCommandBuffer commands);
    /// Counts what is recorded until end(), which is in the same subpass or, as this, outside of render passes.
    void begin(VkCommandBuffer commands);
    void end(VkCommandBuffer commands);
    /// One for each begin() since reset(), after the commands have finished.
    std::vector<PipelineCounts> read() const;
    uint32_t capacity() const { return capacity_; }
    explicit operator bool() const { return static_cast<bool>(pool_); }

  private:
    VkDevice device_ = VK_NULL_HANDLE;
    UniqueQueryPool pool_;
    uint32_t capacity_ = 0;
    uint32_t count_ = 0;
};

}  // namespace splice::gpu
