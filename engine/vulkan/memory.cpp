#include "engine/vulkan/memory.h"

#include "engine/vulkan/handle.h"
#include "preprocess/model_format/error.h"

#include <algorithm>
#include <array>
#include <string>
#include <utility>

namespace splice::gpu {

struct MemoryAllocator::Block {
    struct Hole {
        VkDeviceSize offset, size;
    };
    Unique<VkDeviceMemory, &vkFreeMemory> memory;
    VkDeviceSize size = 0;
    uint32_t type = 0;
    bool image = false;
    bool dedicated = false;
    std::byte* mapped = nullptr;
    std::vector<Hole> holes;  // by offset, never adjacent
};

Memory::Memory(Memory&& other) noexcept
    : allocator_(std::exchange(other.allocator_, nullptr)),
      block_(other.block_),
      memory_(std::exchange(other.memory_, VK_NULL_HANDLE)),
      offset_(other.offset_),
      size_(other.size_),
      mapped_(other.mapped_) {}

Memory& Memory::operator=(Memory&& other) noexcept {
    if (this != &other) {
        if (allocator_) allocator_->release(*this);
        allocator_ = std::exchange(other.allocator_, nullptr);
        block_ = other.block_;
        memory_ = std::exchange(other.memory_, VK_NULL_HANDLE);
        offset_ = other.offset_;
        size_ = other.size_;
        mapped_ = other.mapped_;
    }
    return *this;
}

Memory::~Memory() {
    if (allocator_) allocator_->release(*this);
}

MemoryAllocator::MemoryAllocator(VkPhysicalDevice physical, VkDevice device, VkDeviceSize block_bytes)
    : device_(device), block_bytes_(block_bytes) {
    vkGetPhysicalDeviceMemoryProperties(physical, &properties_);
    VkPhysicalDeviceMaintenance3Properties maintenance{};
    maintenance.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_MAINTENANCE_3_PROPERTIES;
    VkPhysicalDeviceProperties2 properties{};
    properties.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2;
    properties.pNext = &maintenance;
    vkGetPhysicalDeviceProperties2(physical, &properties);
    max_allocation_ = maintenance.maxMemoryAllocationSize;
}

MemoryAllocator::~MemoryAllocator() = default;

uint32_t MemoryAllocator::memory_type(uint32_t type_bits, MemoryUse use) const {
    constexpr VkMemoryPropertyFlags device = VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT;
    constexpr VkMemoryPropertyFlags host = VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
    constexpr VkMemoryPropertyFlags cached = VK_MEMORY_PROPERTY_HOST_CACHED_BIT;
    constexpr VkMemoryPropertyFlags lazy = VK_MEMORY_PROPERTY_LAZILY_ALLOCATED_BIT;
    // Best first; Vulkan guarantees that the last of each list exists for buffers, and device memory for images.
    std::array<VkMemoryPropertyFlags, 3> wishes{};
    switch (use) {
        case MemoryUse::device:
            wishes = {device, device, 0};
            break;
        case MemoryUse::upload:
            wishes = {host, host, host};
            break;
        case MemoryUse::readback:
            wishes = {host | cached, host, host};
            break;
        case MemoryUse::lazy:
            wishes = {device | lazy, device, 0};
            break;
    }
    for (const VkMemoryPropertyFlags wish : wishes) {
        for (uint32_t type = 0; type < properties_.memoryTypeCount; ++type) {
            const VkMemoryPropertyFlags flags = properties_.memoryTypes[type].propertyFlags;
            if ((type_bits >> type & 1U) == 0 || (flags & wish) != wish) continue;
            if ((flags & lazy) != 0 && (wish & lazy) == 0) continue;  // only transient attachments may live there
            return type;
        }
    }
    throw DeviceError("the Vulkan device has no fitting memory type");
}

MemoryAllocator::Block& MemoryAllocator::new_block(uint32_t type, VkDeviceSize bytes, bool image, bool dedicated) {
    auto block = std::make_unique<Block>();
    VkMemoryAllocateInfo allocate{};
    allocate.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO;
    allocate.allocationSize = bytes;
    allocate.memoryTypeIndex = type;
    VkDeviceMemory memory = VK_NULL_HANDLE;
    check(vkAllocateMemory(device_, &allocate, nullptr, &memory),
          "allocating " + std::to_string(bytes) + " bytes of device memory");
    block->memory = Unique<VkDeviceMemory, &vkFreeMemory>(device_, memory);
    block->size = bytes;
    block->type = type;
    block->image = image;
    block->dedicated = dedicated;
    block->holes.push_back({0, bytes});
    const VkMemoryPropertyFlags flags = properties_.memoryTypes[type].propertyFlags;
    constexpr VkMemoryPropertyFlags host = VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
    if (!image && (flags & host) == host) {
        void* mapped = nullptr;
        check(vkMapMemory(device_, memory, 0, VK_WHOLE_SIZE, 0, &mapped), "mapping device memory");
        block->mapped = static_cast<std::byte*>(mapped);
    }
    blocks_.push_back(std::move(block));
    return *blocks_.back();
}

Memory MemoryAllocator::allocate(const VkMemoryRequirements& requirements, MemoryUse use, bool image) {
    const uint32_t type = memory_type(requirements.memoryTypeBits, use);
    if (requirements.size > max_allocation_) {
        throw DeviceError(std::string(image ? "an image" : "a buffer") + " of " + std::to_string(requirements.size) +
                          " bytes is too large for the device, which allocates at most " +
                          std::to_string(max_allocation_) + " bytes at once");
    }
    const auto place = [&](Block& block) -> Memory {
        for (size_t i = 0; i < block.holes.size(); ++i) {
            const Block::Hole hole = block.holes[i];
            const VkDeviceSize mask = std::max<VkDeviceSize>(requirements.alignment, 1) - 1;
            const VkDeviceSize begin = (hole.offset + mask) & ~mask;
            const VkDeviceSize end = begin + requirements.size;
            if (end > hole.offset + hole.size) continue;
            const auto at = block.holes.erase(block.holes.begin() + static_cast<std::ptrdiff_t>(i));
            const std::array<Block::Hole, 2> rest{
                {{hole.offset, begin - hole.offset}, {end, hole.offset + hole.size - end}}};
            auto next = at;
            for (const Block::Hole& piece : rest) {
                if (piece.size > 0) next = block.holes.insert(next, piece) + 1;
            }
            Memory memory;
            memory.allocator_ = this;
            memory.block_ = &block;
            memory.memory_ = block.memory.get();
            memory.offset_ = begin;
            memory.size_ = requirements.size;
            memory.mapped_ = block.mapped ? block.mapped + begin : nullptr;
            return memory;
        }
        return {};
    };
    const bool dedicated = requirements.size > block_bytes_ / 2;
    if (!dedicated) {
        for (const auto& block : blocks_) {
            if (block->dedicated || block->type != type || block->image != image) continue;
            if (Memory memory = place(*block)) return memory;
        }
    }
    const VkDeviceSize bytes = dedicated ? requirements.size : std::min(block_bytes_, max_allocation_);
    return place(new_block(type, bytes, image, dedicated));
}

void MemoryAllocator::release(Memory& memory) {
    auto* block = static_cast<Block*>(memory.block_);
    std::vector<Block::Hole>& holes = block->holes;
    auto next = std::lower_bound(holes.begin(), holes.end(), memory.offset_,
                                 [](const Block::Hole& hole, VkDeviceSize offset) { return hole.offset < offset; });
    next = holes.insert(next, {memory.offset_, memory.size_});
    if (next + 1 != holes.end() && next->offset + next->size == (next + 1)->offset) {
        next->size += (next + 1)->size;
        holes.erase(next + 1);
    }
    if (next != holes.begin() && (next - 1)->offset + (next - 1)->size == next->offset) {
        (next - 1)->size += next->size;
        holes.erase(next);
    }
    memory.allocator_ = nullptr;
    if (block->dedicated) {
        std::erase_if(blocks_, [&](const auto& candidate) { return candidate.get() == block; });
    }
}

MemoryStatistics MemoryAllocator::statistics() const {
    MemoryStatistics statistics;
    statistics.blocks = blocks_.size();
    for (const auto& block : blocks_) {
        statistics.block_bytes += block->size;
        statistics.allocated_bytes += block->size;
        for (const Block::Hole& hole : block->holes)
            statistics.allocated_bytes -= hole.size;
    }
    return statistics;
}

}  // namespace splice::gpu
