#include "engine/vulkan/image.h"

#include "preprocess/model_format/error.h"

#include <algorithm>

namespace splice::gpu {

uint32_t texel_bytes(VkFormat format, VkImageAspectFlagBits aspect) {
    if (aspect == VK_IMAGE_ASPECT_STENCIL_BIT) return 1;
    switch (format) {
        case VK_FORMAT_R8_UNORM:
        case VK_FORMAT_R8_UINT:
            return 1;
        case VK_FORMAT_D16_UNORM:
        case VK_FORMAT_D16_UNORM_S8_UINT:
        case VK_FORMAT_R8G8_UNORM:
        case VK_FORMAT_R16_SFLOAT:
        case VK_FORMAT_R16_UINT:
            return 2;
        case VK_FORMAT_X8_D24_UNORM_PACK32:
        case VK_FORMAT_D24_UNORM_S8_UINT:
        case VK_FORMAT_D32_SFLOAT:
        case VK_FORMAT_D32_SFLOAT_S8_UINT:
        case VK_FORMAT_R8G8B8A8_UNORM:
        case VK_FORMAT_R8G8B8A8_SRGB:
        case VK_FORMAT_B8G8R8A8_UNORM:
        case VK_FORMAT_B8G8R8A8_SRGB:
        case VK_FORMAT_R16G16_SFLOAT:
        case VK_FORMAT_R32_UINT:
        case VK_FORMAT_R32_SINT:
        case VK_FORMAT_R32_SFLOAT:
            return 4;
        case VK_FORMAT_R16G16B16A16_SFLOAT:
        case VK_FORMAT_R32G32_UINT:
        case VK_FORMAT_R32G32_SFLOAT:
            return 8;
        case VK_FORMAT_R32G32B32A32_UINT:
        case VK_FORMAT_R32G32B32A32_SFLOAT:
            return 16;
        default:
            throw DeviceError("no known texel size for VkFormat " + std::to_string(static_cast<int>(format)));
    }
}

UniqueImageView create_image_view(const Device& device, VkImage image, VkFormat format, VkImageAspectFlags aspects,
                                  uint32_t layers) {
    VkImageViewCreateInfo create{};
    create.sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO;
    create.image = image;
    create.viewType = layers > 1 ? VK_IMAGE_VIEW_TYPE_2D_ARRAY : VK_IMAGE_VIEW_TYPE_2D;
    create.format = format;
    create.subresourceRange = {aspects, 0, VK_REMAINING_MIP_LEVELS, 0, VK_REMAINING_ARRAY_LAYERS};
    VkImageView view = VK_NULL_HANDLE;
    check(vkCreateImageView(device.handle(), &create, nullptr, &view), "creating an image view");
    return {device.handle(), view};
}

Image::Image(Device& device, const ImageOptions& options) : options_(options) {
    const std::string what = "the image '" + options.name + "' of " + std::to_string(options.width) + " x " +
                             std::to_string(options.height) + " pixels";
    const uint32_t limit = device.limits().maxImageDimension2D;
    if (options.width == 0 || options.height == 0 || options.width > limit || options.height > limit) {
        throw DeviceError(what + ": the device allows 1 to " + std::to_string(limit) + " each way");
    }
    VkImageCreateInfo create{};
    create.sType = VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO;
    create.imageType = VK_IMAGE_TYPE_2D;
    create.format = options.format;
    create.extent = {options.width, options.height, 1};
    create.mipLevels = options.mip_levels;
    create.arrayLayers = options.layers;
    create.samples = options.samples;
    create.tiling = VK_IMAGE_TILING_OPTIMAL;
    create.usage = options.usage;
    create.sharingMode = VK_SHARING_MODE_EXCLUSIVE;
    create.initialLayout = VK_IMAGE_LAYOUT_UNDEFINED;
    VkImage handle = VK_NULL_HANDLE;
    check(vkCreateImage(device.handle(), &create, nullptr, &handle), "creating " + what);
    image_ = UniqueImage(device.handle(), handle);
    VkMemoryRequirements requirements;
    vkGetImageMemoryRequirements(device.handle(), handle, &requirements);
    memory_ = device.memory().allocate(requirements, options.memory, true);
    check(vkBindImageMemory(device.handle(), handle, memory_.handle(), memory_.offset()),
          "binding the memory of " + what);
    device.set_name(VK_OBJECT_TYPE_IMAGE, handle, options.name);

    constexpr VkImageUsageFlags viewable =
        VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT |
        VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT | VK_IMAGE_USAGE_INPUT_ATTACHMENT_BIT;
    if ((options.usage & viewable) == 0) return;  // only copied: Vulkan forbids a view
    const VkImageAspectFlags aspects = format_aspects(options.format);
    view_ = create_image_view(device, handle, options.format, aspects, options.layers);
    constexpr VkImageAspectFlags both = VK_IMAGE_ASPECT_DEPTH_BIT | VK_IMAGE_ASPECT_STENCIL_BIT;
    if (aspects == both) {
        depth_view_ = create_image_view(device, handle, options.format, VK_IMAGE_ASPECT_DEPTH_BIT, options.layers);
        stencil_view_ = create_image_view(device, handle, options.format, VK_IMAGE_ASPECT_STENCIL_BIT, options.layers);
    }
}

VkImageView Image::view(VkImageAspectFlagBits aspect) const {
    if (!depth_view_) return view_.get();
    return aspect == VK_IMAGE_ASPECT_STENCIL_BIT ? stencil_view_.get() : depth_view_.get();
}

UniqueSampler create_sampler(const Device& device, const SamplerOptions& options) {
    VkSamplerCreateInfo create{};
    create.sType = VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO;
    create.magFilter = create.minFilter = options.filter;
    create.mipmapMode = options.mipmap_mode;
    create.addressModeU = create.addressModeV = create.addressModeW = options.address_mode;
    create.maxLod = VK_LOD_CLAMP_NONE;
    if (options.max_anisotropy > 1 && device.features().sampler_anisotropy) {
        create.anisotropyEnable = VK_TRUE;
        create.maxAnisotropy = std::min(options.max_anisotropy, device.limits().maxSamplerAnisotropy);
    }
    VkSampler sampler = VK_NULL_HANDLE;
    check(vkCreateSampler(device.handle(), &create, nullptr, &sampler), "creating a sampler");
    return {device.handle(), sampler};
}

}  // namespace splice::gpu
