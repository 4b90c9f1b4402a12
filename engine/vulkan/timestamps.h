// Timestamps of the device in milliseconds.
#pragma once

#include "engine/vulkan/device.h"
#include "engine/vulkan/handle.h"

#include <vulkan/vulkan_core.h>

#include <cstdint>
#include <vector>

namespace splice::gpu {

class Timestamps {
  public:
    Timestamps() = default;
    Timestamps(const Device& device, uint32_t capacity);

    /// Outside of a render pass, before the first write of a frame.
    void reset(VkCommandBuffer commands);
    /// The time at which everything recorded before has finished. Returns the index of the stamp.
    uint32_t write(VkCommandBuffer commands);
    /// Milliseconds since the first stamp, one for each write since reset(), after the commands have finished.
    std::vector<double> read_ms() const;
    uint32_t capacity() const { return capacity_; }
    explicit operator bool() const { return static_cast<bool>(pool_); }

  private:
    VkDevice device_ = VK_NULL_HANDLE;
    UniqueQueryPool pool_;
    uint32_t capacity_ = 0;
    uint32_t count_ = 0;
    uint32_t valid_bits_ = 64;
    double ms_per_tick_ = 0;
};

}  // namespace splice::gpu
