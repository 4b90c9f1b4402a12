// Ownership of one Vulkan handle of a device, and the check of a VkResult.
#pragma once

#include "preprocess/model_format/error.h"

#include <vulkan/vulkan_core.h>

#include <string>
#include <utility>

namespace splice::gpu {

/// The device stopped working; everything made with it is gone, but another one may do.
class DeviceLostError : public DeviceError {
  public:
    using DeviceError::DeviceError;
};

/// The window's surface is gone, but another one may do.
class SurfaceLostError : public DeviceError {
  public:
    using DeviceError::DeviceError;
};

/// Throws DeviceError "WHAT: VK_ERROR_..." unless result is VK_SUCCESS; a lost device or surface as its own type.
void check(VkResult result, const std::string& what);

/// "VK_ERROR_DEVICE_LOST" and the like; "VkResult N" for codes without a name here.
std::string result_name(VkResult result);

/// Owns a handle that is destroyed with `destroy(device, handle, nullptr)`. Movable; empty by default.
template <typename T, auto destroy>
class Unique {
  public:
    Unique() = default;
    Unique(VkDevice device, T handle) : device_(device), handle_(handle) {}
    Unique(Unique&& other) noexcept
        : device_(other.device_), handle_(std::exchange(other.handle_, static_cast<T>(VK_NULL_HANDLE))) {}
    Unique& operator=(Unique&& other) noexcept {
        if (this != &other) {
            reset();
            device_ = other.device_;
            handle_ = std::exchange(other.handle_, static_cast<T>(VK_NULL_HANDLE));
        }
        return *this;
    }
    Unique(const Unique&) = delete;
    Unique& operator=(const Unique&) = delete;
    ~Unique() { reset(); }

    T get() const { return handle_; }
    explicit operator bool() const { return handle_ != static_cast<T>(VK_NULL_HANDLE); }
    void reset() {
        if (*this) destroy(device_, std::exchange(handle_, static_cast<T>(VK_NULL_HANDLE)), nullptr);
    }

  private:
    VkDevice device_ = VK_NULL_HANDLE;
    T handle_ = VK_NULL_HANDLE;
};

using UniqueBuffer = Unique<VkBuffer, &vkDestroyBuffer>;
using UniqueBufferView = Unique<VkBufferView, &vkDestroyBufferView>;
using UniqueImage = Unique<VkImage, &vkDestroyImage>;
using UniqueImageView = Unique<VkImageView, &vkDestroyImageView>;
using UniqueSampler = Unique<VkSampler, &vkDestroySampler>;
using UniqueShaderModule = Unique<VkShaderModule, &vkDestroyShaderModule>;
using UniqueDescriptorSetLayout = Unique<VkDescriptorSetLayout, &vkDestroyDescriptorSetLayout>;
using UniqueDescriptorPool = Unique<VkDescriptorPool, &vkDestroyDescriptorPool>;
using UniquePipelineLayout = Unique<VkPipelineLayout, &vkDestroyPipelineLayout>;
using UniquePipeline = Unique<VkPipeline, &vkDestroyPipeline>;
using UniquePipelineCache = Unique<VkPipelineCache, &vkDestroyPipelineCache>;
using UniqueRenderPass = Unique<VkRenderPass, &vkDestroyRenderPass>;
using UniqueFramebuffer = Unique<VkFramebuffer, &vkDestroyFramebuffer>;
using UniqueQueryPool = Unique<VkQueryPool, &vkDestroyQueryPool>;
using UniqueCommandPool = Unique<VkCommandPool, &vkDestroyCommandPool>;
using UniqueFence = Unique<VkFence, &vkDestroyFence>;
using UniqueSwapchain = Unique<VkSwapchainKHR, &vkDestroySwapchainKHR>;
using UniqueSemaphore = Unique<VkSemaphore, &vkDestroySemaphore>;

}  // namespace splice::gpu
