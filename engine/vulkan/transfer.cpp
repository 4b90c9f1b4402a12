#include "engine/vulkan/transfer.h"

#include "preprocess/model_format/error.h"

#include <algorithm>
#include <cstring>

namespace splice::gpu {
namespace {

constexpr uint64_t kStagingBytes = uint64_t{32} << 20;

/// Later commands of the queue, in this submission or the next, see what earlier ones wrote.
void full_barrier(VkCommandBuffer commands) {
    VkMemoryBarrier2 barrier{};
    barrier.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER_2;
    barrier.srcStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
    barrier.srcAccessMask = VK_ACCESS_2_MEMORY_WRITE_BIT;
    barrier.dstStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
    barrier.dstAccessMask = VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT;
    VkDependencyInfo dependency{};
    dependency.sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO;
    dependency.memoryBarrierCount = 1;
    dependency.pMemoryBarriers = &barrier;
    vkCmdPipelineBarrier2(commands, &dependency);
}

void host_barrier(VkCommandBuffer commands) {
    VkMemoryBarrier2 barrier{};
    barrier.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER_2;
    barrier.srcStageMask = VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT;
    barrier.srcAccessMask = VK_ACCESS_2_TRANSFER_WRITE_BIT;
    barrier.dstStageMask = VK_PIPELINE_STAGE_2_HOST_BIT;
    barrier.dstAccessMask = VK_ACCESS_2_HOST_READ_BIT;
    VkDependencyInfo dependency{};
    dependency.sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO;
    dependency.memoryBarrierCount = 1;
    dependency.pMemoryBarriers = &barrier;
    vkCmdPipelineBarrier2(commands, &dependency);
}

void transition(VkCommandBuffer commands, const Image& image, VkImageLayout from, VkImageLayout to) {
    VkImageMemoryBarrier2 barrier{};
    barrier.sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2;
    barrier.srcStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
    barrier.srcAccessMask = VK_ACCESS_2_MEMORY_WRITE_BIT;
    barrier.dstStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
    barrier.dstAccessMask = VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT;
    barrier.oldLayout = from;
    barrier.newLayout = to;
    barrier.srcQueueFamilyIndex = barrier.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
    barrier.image = image.handle();
    barrier.subresourceRange = {format_aspects(image.options().format), 0, VK_REMAINING_MIP_LEVELS, 0,
                                VK_REMAINING_ARRAY_LAYERS};
    VkDependencyInfo dependency{};
    dependency.sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO;
    dependency.imageMemoryBarrierCount = 1;
    dependency.pImageMemoryBarriers = &barrier;
    vkCmdPipelineBarrier2(commands, &dependency);
}

Buffer staging_buffer(Device& device, uint64_t size) {
    return Buffer(device, {size, VK_BUFFER_USAGE_TRANSFER_SRC_BIT, MemoryUse::upload, "staging"});
}

Buffer readback_buffer(Device& device, uint64_t size) {
    return Buffer(device, {size, VK_BUFFER_USAGE_TRANSFER_DST_BIT, MemoryUse::readback, "read-back"});
}

void check_range(const Buffer& buffer, uint64_t offset, uint64_t size) {
    if (offset > buffer.size() || size > buffer.size() - offset) {
        throw DeviceError("a transfer of " + std::to_string(size) + " bytes at " + std::to_string(offset) +
                          " does not fit a buffer of " + std::to_string(buffer.size()));
    }
}

}  // namespace

void upload(Device& device, const Buffer& buffer, std::span<const std::byte> bytes, uint64_t offset) {
    check_range(buffer, offset, bytes.size());
    if (bytes.empty()) return;
    if (!buffer.mapped().empty() && !device.force_staging()) {
        // Queue submission makes host writes visible to every command submitted later.
        std::memcpy(buffer.mapped().data() + offset, bytes.data(), bytes.size());
        return;
    }
    const Buffer staging = staging_buffer(device, std::min<uint64_t>(bytes.size(), kStagingBytes));
    for (uint64_t done = 0; done < bytes.size(); done += kStagingBytes) {
        const uint64_t size = std::min<uint64_t>(kStagingBytes, bytes.size() - done);
        std::memcpy(staging.mapped().data(), bytes.data() + done, size);
        device.submit_and_wait([&](VkCommandBuffer commands) {
            full_barrier(commands);  // earlier uses of the buffer
            const VkBufferCopy copy{0, offset + done, size};
            vkCmdCopyBuffer(commands, staging.handle(), buffer.handle(), 1, &copy);
            full_barrier(commands);
        });
    }
}

Buffer create_buffer(Device& device, BufferOptions options, std::span<const std::byte> bytes) {
    options.size = bytes.size();
    Buffer buffer(device, options);
    upload(device, buffer, bytes);
    return buffer;
}

void upload(Device& device, const Image& image, std::span<const std::byte> bytes,
            std::span<const VkBufferImageCopy> regions, VkImageLayout layout) {
    const Buffer staging = staging_buffer(device, bytes.size());
    std::memcpy(staging.mapped().data(), bytes.data(), bytes.size());
    device.submit_and_wait([&](VkCommandBuffer commands) {
        transition(commands, image, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL);
        vkCmdCopyBufferToImage(commands, staging.handle(), image.handle(), VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
                               static_cast<uint32_t>(regions.size()), regions.data());
        transition(commands, image, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, layout);
    });
}

std::vector<std::byte> read_back(Device& device, const Buffer& buffer, uint64_t offset, uint64_t size) {
    check_range(buffer, offset, size);
    if (size == 0) return {};
    const Buffer target = readback_buffer(device, size);
    device.submit_and_wait([&](VkCommandBuffer commands) {
        full_barrier(commands);
        const VkBufferCopy copy{offset, 0, size};
        vkCmdCopyBuffer(commands, buffer.handle(), target.handle(), 1, &copy);
        host_barrier(commands);
    });
    return {target.mapped().begin(), target.mapped().begin() + static_cast<std::ptrdiff_t>(size)};
}

std::vector<std::byte> read_back(Device& device, const Image& image, VkImageLayout layout,
                                 VkImageAspectFlagBits aspect) {
    const ImageOptions& options = image.options();
    const uint64_t size = uint64_t{options.width} * options.height * texel_bytes(options.format, aspect);
    const Buffer target = readback_buffer(device, size);
    device.submit_and_wait([&](VkCommandBuffer commands) {
        transition(commands, image, layout, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL);
        VkBufferImageCopy copy{};
        copy.imageSubresource = {static_cast<VkImageAspectFlags>(aspect), 0, 0, 1};
        copy.imageExtent = {options.width, options.height, 1};
        vkCmdCopyImageToBuffer(commands, image.handle(), VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, target.handle(), 1,
                               &copy);
        transition(commands, image, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, layout);
        host_barrier(commands);
    });
    return {target.mapped().begin(), target.mapped().begin() + static_cast<std::ptrdiff_t>(size)};
}

}  // namespace splice::gpu
