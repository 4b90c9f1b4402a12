// Where a window shows images: a handle of the instance, made by the window system's library.
#pragma once

#include "engine/vulkan/instance.h"

#include <vulkan/vulkan_core.h>

#include <utility>

namespace splice::gpu {

class Surface {
  public:
    Surface() = default;
    /// Takes ownership. The instance must outlive the surface.
    Surface(const Instance& instance, VkSurfaceKHR surface) : instance_(instance.handle()), surface_(surface) {}
    Surface(Surface&& other) noexcept
        : instance_(other.instance_), surface_(std::exchange(other.surface_, VkSurfaceKHR{VK_NULL_HANDLE})) {}
    Surface& operator=(Surface&& other) noexcept;
    Surface(const Surface&) = delete;
    Surface& operator=(const Surface&) = delete;
    ~Surface() { reset(); }

    VkSurfaceKHR handle() const { return surface_; }
    void reset();

  private:
    VkInstance instance_ = VK_NULL_HANDLE;
    VkSurfaceKHR surface_ = VK_NULL_HANDLE;
};

}  // namespace splice::gpu
