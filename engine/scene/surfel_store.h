// Surfel records on a device: as vertices of passes that rasterise, and as texels of those that compute.
#pragma once

#include "engine/scene/surfel_bounds.h"
#include "engine/vulkan/buffer.h"
#include "engine/vulkan/descriptor.h"
#include "engine/vulkan/device.h"

#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace splice {

namespace format {
struct Surfel;
}

/// Set 1 of compute passes over surfels: binding 0 the records of a chunk as texels, R32G32B32A32_UINT: two each, of
/// packed surfels one.
gpu::DescriptorSetLayout surfel_set_layout(const gpu::Device& device);

/// Surfels that one binding holds.
struct SurfelChunk {
    VkDescriptorSet set = VK_NULL_HANDLE;
    std::uint64_t first = 0, count = 0;
};

enum class SurfelRecords { kPlain, kPacked };  // format::Surfel, format::PackedSurfel

class SurfelStore {
  public:
    /// Room for `surfels`; the device must outlive the store. Throws DeviceError.
    SurfelStore(gpu::Device& device, std::uint64_t surfels, SurfelRecords records, gpu::MemoryUse memory,
                const std::string& name);

    const gpu::Buffer& buffer() const { return buffer_; }
    std::uint64_t capacity() const { return capacity_; }
    bool is_packed() const { return records_ == SurfelRecords::kPacked; }
    /// Bytes a surfel.
    std::uint64_t stride() const { return stride_; }
    /// All surfels, in order, in as many pieces as the device's texel buffers need.
    const std::vector<SurfelChunk>& chunks() const { return chunks_; }
    /// Of a store of plain records, where the host sees them; empty if it does not.
    std::span<format::Surfel> mapped() const;
    /// Of what was put there, kBoundedSurfels each; empty: not known.
    std::span<const SurfelBounds> bounds() const { return bounds_; }
    void set_bounds(std::vector<SurfelBounds> bounds) { bounds_ = std::move(bounds); }

  private:
    SurfelRecords records_;
    std::uint64_t stride_;
    std::uint64_t capacity_;
    gpu::Buffer buffer_;
    gpu::DescriptorSetLayout layout_;
    gpu::DescriptorPool pool_;
    std::vector<gpu::UniqueBufferView> views_;
    std::vector<SurfelChunk> chunks_;
    std::vector<SurfelBounds> bounds_;
};

}  // namespace splice
