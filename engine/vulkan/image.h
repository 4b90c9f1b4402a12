// An image with its memory and views; samplers.
#pragma once

#include "engine/vulkan/device.h"
#include "engine/vulkan/format_aspects.h"
#include "engine/vulkan/handle.h"
#include "engine/vulkan/memory.h"

#include <vulkan/vulkan_core.h>

#include <cstdint>
#include <string>

namespace splice::gpu {

/// Bytes a texel of one aspect when copied to a buffer (D32_SFLOAT_S8_UINT: 4 for depth, 1 for stencil). Throws
/// DeviceError for formats that the engine does not use.
uint32_t texel_bytes(VkFormat format, VkImageAspectFlagBits aspect);

struct ImageOptions {
    VkFormat format = VK_FORMAT_UNDEFINED;
    uint32_t width = 1;   ///< pixels
    uint32_t height = 1;  ///< pixels
    uint32_t mip_levels = 1;
    uint32_t layers = 1;
    VkSampleCountFlagBits samples = VK_SAMPLE_COUNT_1_BIT;
    VkImageUsageFlags usage = 0;
    MemoryUse memory = MemoryUse::device;
    std::string name = {};
};

/// A 2D image, optimally tiled. Views are 2D arrays only when layers > 1.
class Image {
  public:
    Image() = default;
    /// Throws DeviceError (size beyond the limits of the device included).
    Image(Device& device, const ImageOptions& options);

    VkImage handle() const { return image_.get(); }
    const ImageOptions& options() const { return options_; }
    VkImageView view() const { return view_.get(); }  ///< all aspects, levels and layers: attachments, colour reads
    /// One aspect, which shaders need of a depth-stencil image. The same as view() for images of one aspect.
    VkImageView view(VkImageAspectFlagBits aspect) const;
    explicit operator bool() const { return static_cast<bool>(image_); }

  private:
    Memory memory_;  // before the handle: destroyed after it
    UniqueImage image_;
    UniqueImageView view_, depth_view_, stencil_view_;
    ImageOptions options_;
};

/// A view of all levels and layers of an image; VK_NULL_HANDLE is never returned. Throws DeviceError.
UniqueImageView create_image_view(const Device& device, VkImage image, VkFormat format, VkImageAspectFlags aspects,
                                  uint32_t layers = 1);

struct SamplerOptions {
    VkFilter filter = VK_FILTER_LINEAR;
    VkSamplerMipmapMode mipmap_mode = VK_SAMPLER_MIPMAP_MODE_LINEAR;
    VkSamplerAddressMode address_mode = VK_SAMPLER_ADDRESS_MODE_REPEAT;
    float max_anisotropy = 1;  ///< above 1: clamped to the device's limit, ignored without the feature
};
UniqueSampler create_sampler(const Device& device, const SamplerOptions& options = {});

}  // namespace splice::gpu
