// Surfel records on a device: as vertices of passes that rasterise, and as texels of those that compute.
#pragma once

#include "engine/vulkan/buffer.h"
#include "engine/vulkan/descriptor.h"
#include "engine/vulkan/device.h"

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace splice {

namespace format {
struct Surfel;
}

/// Set 1 of compute passes over surfels: binding 0 the records of a chunk as texels,
/// R32G32B32A32_UINT, two each.
gpu::DescriptorSetLayout surfel_set_layout(const gpu::Device& device);

/// Surfels that one binding holds.
struct SurfelChunk {
    VkDescriptorSet set = VK_NULL_HANDLE;
    std::uint64_t first = 0, count = 0;
};

class SurfelStore {
  public:
    /// Room for `surfels`; the device must outlive the store. Throws DeviceError.
    SurfelStore(gpu::Device& device, std::uint64_t surfels, gpu::MemoryUse memory, const std::string& name);

    const gpu::Buffer& buffer() const { return buffer_; }
    std::uint64_t capacity() const { return capacity_; }
    /// All surfels, in order, in as many pieces as the device's texel buffers need.
    const std::vector<SurfelChunk>& chunks() const { return chunks_; }
    /// Where the host sees them; empty if it does not.
    std::span<format::Surfel> mapped() const;

  private:
    std::uint64_t capacity_;
    gpu::Buffer buffer_;
    gpu::DescriptorSetLayout layout_;
    gpu::DescriptorPool pool_;
    std::vector<gpu::UniqueBufferView> views_;
    std::vector<SurfelChunk> chunks_;
};

}  // namespace splice
