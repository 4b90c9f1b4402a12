// A buffer with its memory.
#pragma once

#include "engine/vulkan/device.h"
#include "engine/vulkan/handle.h"
#include "engine/vulkan/memory.h"

#include <vulkan/vulkan_core.h>

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace splice::gpu {

struct BufferOptions {
    uint64_t size = 0;             ///< bytes; 0 is rounded up to 4, so that an empty section still binds
    VkBufferUsageFlags usage = 0;  ///< device memory adds TRANSFER_DST and TRANSFER_SRC
    MemoryUse memory = MemoryUse::device;
    std::string name = {};
};

class Buffer {
  public:
    Buffer() = default;
    /// Throws DeviceError.
    Buffer(Device& device, const BufferOptions& options);

    VkBuffer handle() const { return buffer_.get(); }
    uint64_t size() const { return size_; }
    /// The bytes as the host sees them; empty when it cannot. Coherent: no flush needed.
    std::span<std::byte> mapped() const;
    explicit operator bool() const { return static_cast<bool>(buffer_); }

  private:
    Memory memory_;  // before the handle: destroyed after it
    UniqueBuffer buffer_;
    uint64_t size_ = 0;
};

/// `size` bytes of a buffer as texels; at most maxTexelBufferElements of them. Throws DeviceError.
UniqueBufferView create_texel_view(const Device& device, const Buffer& buffer, VkFormat format, uint64_t offset = 0,
                                   uint64_t size = VK_WHOLE_SIZE);

/// A piece of a storage buffer that fits one descriptor.
struct StorageChunk {
    uint64_t offset = 0;         ///< bytes, a multiple of minStorageBufferOffsetAlignment
    uint64_t size = 0;           ///< bytes, at most maxStorageBufferRange
    uint64_t first_element = 0;  ///< offset / element_size
    uint64_t elements = 0;
};

/// Cuts `elements` elements of `element_size` bytes into pieces that a storage descriptor can bind
/// (maxStorageBufferRange is 128 MiB on lavapipe). No element is split; one empty chunk for no elements.
std::vector<StorageChunk> storage_chunks(const VkPhysicalDeviceLimits& limits, uint64_t elements,
                                         uint64_t element_size);

}  // namespace splice::gpu
