#include "engine/vulkan/buffer.h"

#include "preprocess/model_format/error.h"

#include <algorithm>
#include <numeric>

namespace splice::gpu {

Buffer::Buffer(Device& device, const BufferOptions& options) : size_(std::max<uint64_t>(options.size, 4)) {
    VkBufferCreateInfo create{};
    create.sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO;
    create.size = size_;
    create.usage = options.usage;
    if (options.memory == MemoryUse::device) {
        create.usage |= VK_BUFFER_USAGE_TRANSFER_DST_BIT | VK_BUFFER_USAGE_TRANSFER_SRC_BIT;
    }
    create.sharingMode = VK_SHARING_MODE_EXCLUSIVE;
    VkBuffer handle = VK_NULL_HANDLE;
    check(vkCreateBuffer(device.handle(), &create, nullptr, &handle),
          "creating the buffer '" + options.name + "' of " + std::to_string(size_) + " bytes");
    buffer_ = UniqueBuffer(device.handle(), handle);
    VkMemoryRequirements requirements;
    vkGetBufferMemoryRequirements(device.handle(), handle, &requirements);
    memory_ = device.memory().allocate(requirements, options.memory, false);
    check(vkBindBufferMemory(device.handle(), handle, memory_.handle(), memory_.offset()),
          "binding the memory of '" + options.name + "'");
    device.set_name(VK_OBJECT_TYPE_BUFFER, handle, options.name);
}

std::span<std::byte> Buffer::mapped() const {
    if (!memory_.mapped()) return {};
    return {memory_.mapped(), static_cast<size_t>(size_)};
}

UniqueBufferView create_texel_view(const Device& device, const Buffer& buffer, VkFormat format, uint64_t offset,
                                   uint64_t size) {
    VkBufferViewCreateInfo create{};
    create.sType = VK_STRUCTURE_TYPE_BUFFER_VIEW_CREATE_INFO;
    create.buffer = buffer.handle();
    create.format = format;
    create.offset = offset;
    create.range = size;
    VkBufferView view = VK_NULL_HANDLE;
    check(vkCreateBufferView(device.handle(), &create, nullptr, &view), "creating a view of texels");
    return UniqueBufferView(device.handle(), view);
}

std::vector<StorageChunk> storage_chunks(const VkPhysicalDeviceLimits& limits, uint64_t elements,
                                         uint64_t element_size) {
    // Chunks start at multiples of both the element and the alignment that a descriptor's offset needs.
    const uint64_t alignment = std::max<uint64_t>(limits.minStorageBufferOffsetAlignment, 1);
    const uint64_t step = std::lcm(std::max<uint64_t>(element_size, 1), alignment);
    const uint64_t chunk_bytes = limits.maxStorageBufferRange / step * step;
    if (element_size == 0 || chunk_bytes == 0) {
        throw DeviceError("elements of " + std::to_string(element_size) + " bytes do not fit a storage buffer of " +
                          std::to_string(limits.maxStorageBufferRange) + " bytes");
    }
    const uint64_t chunk_elements = chunk_bytes / element_size;
    std::vector<StorageChunk> chunks;
    for (uint64_t first = 0; first < elements || chunks.empty(); first += chunk_elements) {
        const uint64_t count = std::min(chunk_elements, elements - first);
        chunks.push_back({first * element_size, count * element_size, first, count});
    }
    return chunks;
}

}  // namespace splice::gpu
