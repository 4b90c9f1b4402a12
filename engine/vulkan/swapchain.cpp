#include "engine/vulkan/swapchain.h"

#include "engine/vulkan/image.h"

#include <algorithm>

namespace splice::gpu {

namespace {

UniqueSemaphore create_semaphore(const Device& device) {
    VkSemaphoreCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO;
    VkSemaphore semaphore = VK_NULL_HANDLE;
    check(vkCreateSemaphore(device.handle(), &info, nullptr, &semaphore), "creating a semaphore");
    return {device.handle(), semaphore};
}

const PresentModeName& vulkan_mode(PresentMode mode) {
    return kPresentModeNames[static_cast<size_t>(mode)];
}

bool has_mode(VkPhysicalDevice physical, VkSurfaceKHR surface, PresentMode mode) {
    uint32_t count = 0;
    check(vkGetPhysicalDeviceSurfacePresentModesKHR(physical, surface, &count, nullptr), "listing present modes");
    std::vector<VkPresentModeKHR> modes(count);
    check(vkGetPhysicalDeviceSurfacePresentModesKHR(physical, surface, &count, modes.data()), "listing present modes");
    return std::find(modes.begin(), modes.end(), vulkan_mode(mode).vulkan) != modes.end();
}

}  // namespace

std::optional<PresentMode> present_mode_of_name(std::string_view name) {
    for (const PresentModeName& known : kPresentModeNames)
        if (known.name == name) return known.mode;
    return std::nullopt;
}

bool is_lost(const Device& device, VkSurfaceKHR surface) {
    VkSurfaceCapabilitiesKHR ignored;
    return vkGetPhysicalDeviceSurfaceCapabilitiesKHR(device.physical(), surface, &ignored) == VK_ERROR_SURFACE_LOST_KHR;
}

Swapchain::Swapchain(Device& device, VkSurfaceKHR surface) : device_(device), surface_(surface) {
    choose_format();
}

Swapchain::~Swapchain() {
    vkDeviceWaitIdle(device_.handle());
}

// The engine's pictures are sRGB-encoded already, so what shows them must not encode again.
void Swapchain::choose_format() {
    uint32_t count = 0;
    check(vkGetPhysicalDeviceSurfaceFormatsKHR(device_.physical(), surface_, &count, nullptr), "listing formats");
    std::vector<VkSurfaceFormatKHR> formats(count);
    check(vkGetPhysicalDeviceSurfaceFormatsKHR(device_.physical(), surface_, &count, formats.data()),
          "listing formats");
    for (const VkFormat wanted : {VK_FORMAT_B8G8R8A8_UNORM, VK_FORMAT_R8G8B8A8_UNORM}) {
        for (const VkSurfaceFormatKHR& format : formats) {
            if (format.format != wanted || format.colorSpace != VK_COLOR_SPACE_SRGB_NONLINEAR_KHR) continue;
            format_ = format;
            return;
        }
    }
    throw DeviceError("'" + device_.info().name + "' shows no 8-bit images in this window");
}

bool Swapchain::fits(VkExtent2D window) const {
    return !out_of_date_ && window.width == window_.width && window.height == window_.height;
}

VkSurfaceCapabilitiesKHR Swapchain::capabilities() const {
    VkSurfaceCapabilitiesKHR found;
    check(vkGetPhysicalDeviceSurfaceCapabilitiesKHR(device_.physical(), surface_, &found),
          "asking what the window can show");
    return found;
}

bool Swapchain::recreate(VkExtent2D window, PresentMode mode) {
    const VkSurfaceCapabilitiesKHR found = capabilities();
    // UINT32_MAX: the surface takes the size of its images.
    extent_ = found.currentExtent;
    if (extent_.width == UINT32_MAX) {
        extent_ = {std::clamp(window.width, found.minImageExtent.width, found.maxImageExtent.width),
                   std::clamp(window.height, found.minImageExtent.height, found.maxImageExtent.height)};
    }
    if (window.width == 0 || window.height == 0 || extent_.width == 0 || extent_.height == 0) return false;
    device_.wait_idle();
    mode_ = has_mode(device_.physical(), surface_, mode) ? mode : PresentMode::fifo;
    window_ = window;
    create(found);
    create_images();
    out_of_date_ = false;
    return true;
}

void Swapchain::create(const VkSurfaceCapabilitiesKHR& capabilities) {
    constexpr VkImageUsageFlags needed = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT;
    if ((capabilities.supportedUsageFlags & needed) != needed)
        throw DeviceError("'" + device_.info().name + "' cannot copy to the images of this window");
    usage_ = needed | (capabilities.supportedUsageFlags & VK_IMAGE_USAGE_TRANSFER_SRC_BIT);
    VkSwapchainCreateInfoKHR info{};
    info.sType = VK_STRUCTURE_TYPE_SWAPCHAIN_CREATE_INFO_KHR;
    info.surface = surface_;
    info.minImageCount = std::max(capabilities.minImageCount, 3U);
    if (capabilities.maxImageCount != 0) info.minImageCount = std::min(info.minImageCount, capabilities.maxImageCount);
    info.imageFormat = format_.format;
    info.imageColorSpace = format_.colorSpace;
    info.imageExtent = extent_;
    info.imageArrayLayers = 1;
    info.imageUsage = usage_;
    info.imageSharingMode = VK_SHARING_MODE_EXCLUSIVE;
    info.preTransform = capabilities.currentTransform;
    const bool opaque = (capabilities.supportedCompositeAlpha & VK_COMPOSITE_ALPHA_OPAQUE_BIT_KHR) != 0;
    info.compositeAlpha = opaque ? VK_COMPOSITE_ALPHA_OPAQUE_BIT_KHR : VK_COMPOSITE_ALPHA_INHERIT_BIT_KHR;
    info.presentMode = vulkan_mode(mode_).vulkan;
    info.clipped = VK_TRUE;
    info.oldSwapchain = swapchain_.get();
    VkSwapchainKHR handle = VK_NULL_HANDLE;
    check(vkCreateSwapchainKHR(device_.handle(), &info, nullptr, &handle), "creating the images of the window");
    views_.clear();
    swapchain_ = UniqueSwapchain(device_.handle(), handle);
}

void Swapchain::create_images() {
    uint32_t count = 0;
    check(vkGetSwapchainImagesKHR(device_.handle(), swapchain_.get(), &count, nullptr), "listing the window's images");
    images_.resize(count);
    check(vkGetSwapchainImagesKHR(device_.handle(), swapchain_.get(), &count, images_.data()),
          "listing the window's images");
    acquired_ = create_semaphore(device_);
    drawn_.clear();
    for (const VkImage image : images_) {
        views_.push_back(create_image_view(device_, image, format_.format, VK_IMAGE_ASPECT_COLOR_BIT));
        drawn_.push_back(create_semaphore(device_));
    }
}

std::optional<uint32_t> Swapchain::acquire() {
    const VkResult result = vkAcquireNextImageKHR(device_.handle(), swapchain_.get(), UINT64_MAX, acquired_.get(),
                                                  VK_NULL_HANDLE, &current_);
    if (result == VK_ERROR_OUT_OF_DATE_KHR) {
        out_of_date_ = true;
        return std::nullopt;
    }
    // A suboptimal image is acquired all the same: it is shown, and the next ones fit.
    if (result == VK_SUBOPTIMAL_KHR) {
        out_of_date_ = true;
    } else {
        check(result, "taking an image of the window");
    }
    return current_;
}

SubmitSemaphores Swapchain::semaphores(VkPipelineStageFlags first_stages) const {
    return {acquired_.get(), first_stages, drawn_[current_].get()};
}

void Swapchain::present() {
    const VkSwapchainKHR swapchain = swapchain_.get();
    const VkSemaphore drawn = drawn_[current_].get();
    VkPresentInfoKHR info{};
    info.sType = VK_STRUCTURE_TYPE_PRESENT_INFO_KHR;
    info.waitSemaphoreCount = 1;
    info.pWaitSemaphores = &drawn;
    info.swapchainCount = 1;
    info.pSwapchains = &swapchain;
    info.pImageIndices = &current_;
    const VkResult result = vkQueuePresentKHR(device_.queue(), &info);
    if (result == VK_ERROR_OUT_OF_DATE_KHR || result == VK_SUBOPTIMAL_KHR) {
        out_of_date_ = true;
    } else {
        check(result, "showing an image in the window");
    }
}

}  // namespace splice::gpu
