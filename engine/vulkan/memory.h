// Device memory: large blocks a memory type, suballocated first-fit, each block mapped once if the host can see it.
// Buffers and optimally tiled images never share a block, so bufferImageGranularity needs no care.
#pragma once

#include <vulkan/vulkan_core.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

namespace splice::gpu {

enum class MemoryUse {
    device,    ///< read and written by the device; may happen to be mapped (integrated GPUs, software)
    upload,    ///< written by the host in order, read by the device: staging, uniforms. Coherent, mapped
    readback,  ///< written by the device, read by the host. Coherent, mapped, cached where possible
    lazy,      ///< attachments that never leave a tile; device memory where there is no lazily allocated type
};

class MemoryAllocator;

/// A range of a block; returned to its block at the end of its life. The allocator must outlive it.
class Memory {
  public:
    Memory() = default;
    Memory(Memory&& other) noexcept;
    Memory& operator=(Memory&& other) noexcept;
    Memory(const Memory&) = delete;
    Memory& operator=(const Memory&) = delete;
    ~Memory();

    VkDeviceMemory handle() const { return memory_; }
    VkDeviceSize offset() const { return offset_; }
    VkDeviceSize size() const { return size_; }
    std::byte* mapped() const { return mapped_; }  ///< at offset(); null if the host cannot see it
    explicit operator bool() const { return memory_ != VK_NULL_HANDLE; }

  private:
    friend class MemoryAllocator;
    MemoryAllocator* allocator_ = nullptr;
    void* block_ = nullptr;
    VkDeviceMemory memory_ = VK_NULL_HANDLE;
    VkDeviceSize offset_ = 0;
    VkDeviceSize size_ = 0;
    std::byte* mapped_ = nullptr;
};

struct MemoryStatistics {
    uint64_t blocks = 0;           ///< VkDeviceMemory objects alive
    uint64_t block_bytes = 0;      ///< their total size
    uint64_t allocated_bytes = 0;  ///< handed out
};

class MemoryAllocator {
  public:
    /// block_bytes: size of a shared block; what is larger than half of it gets a block of its own.
    MemoryAllocator(VkPhysicalDevice physical, VkDevice device, VkDeviceSize block_bytes = VkDeviceSize{64} << 20);
    ~MemoryAllocator();
    MemoryAllocator(const MemoryAllocator&) = delete;
    MemoryAllocator& operator=(const MemoryAllocator&) = delete;

    /// image: for an optimally tiled image rather than a buffer. Throws DeviceError when no memory type fits or memory
    /// is exhausted, naming the size.
    Memory allocate(const VkMemoryRequirements& requirements, MemoryUse use, bool image);

    /// Index of the memory type that allocate() would use. Throws DeviceError.
    uint32_t memory_type(uint32_t type_bits, MemoryUse use) const;
    MemoryStatistics statistics() const;

  private:
    friend class Memory;
    struct Block;
    void release(Memory& memory);
    Block& new_block(uint32_t type, VkDeviceSize bytes, bool image, bool dedicated);

    VkDevice device_;
    VkPhysicalDeviceMemoryProperties properties_{};
    VkDeviceSize max_allocation_ = 0;
    VkDeviceSize block_bytes_;
    std::vector<std::unique_ptr<Block>> blocks_;
};

}  // namespace splice::gpu
