// Data between the host and the device, outside of any frame: each call submits and waits.
#pragma once

#include "engine/vulkan/buffer.h"
#include "engine/vulkan/device.h"
#include "engine/vulkan/image.h"

#include <vulkan/vulkan_core.h>

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace splice::gpu {

/// Writes through the mapping where there is one, else through staging pieces of at most 32 MiB. Afterwards every later
/// command sees the bytes. No submitted work may still use the range. Throws DeviceError when the range lies outside
/// the buffer.
void upload(Device& device, const Buffer& buffer, std::span<const std::byte> bytes, uint64_t offset = 0);

/// A device buffer holding `bytes`.
Buffer create_buffer(Device& device, BufferOptions options, std::span<const std::byte> bytes);

/// Fills an image whose content is not needed any more and leaves it in `layout`, visible to every later command.
/// Regions count from the start of `bytes`, tightly packed, bufferOffset a multiple of 4 and of the texel size.
void upload(Device& device, const Image& image, std::span<const std::byte> bytes,
            std::span<const VkBufferImageCopy> regions,
            VkImageLayout layout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);

/// The bytes of a buffer after all submitted work.
std::vector<std::byte> read_back(Device& device, const Buffer& buffer, uint64_t offset, uint64_t size);

/// Level 0, layer 0 of one aspect, rows tightly packed from the top, after all submitted work. `layout` is the layout
/// that the image is in and is returned to; usage must have TRANSFER_SRC.
std::vector<std::byte> read_back(Device& device, const Image& image, VkImageLayout layout,
                                 VkImageAspectFlagBits aspect = VK_IMAGE_ASPECT_COLOR_BIT);

/// Any trivially copyable elements as bytes.
template <typename T>
std::span<const std::byte> bytes_of(std::span<const T> elements) {
    return std::as_bytes(elements);
}
template <typename T>
std::span<const std::byte> bytes_of(const std::vector<T>& elements) {
    return std::as_bytes(std::span<const T>(elements));
}

}  // namespace splice::gpu
