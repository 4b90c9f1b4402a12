#include "engine/vulkan/surface.h"

namespace splice::gpu {

Surface& Surface::operator=(Surface&& other) noexcept {
    if (this != &other) {
        reset();
        instance_ = other.instance_;
        surface_ = std::exchange(other.surface_, VkSurfaceKHR{VK_NULL_HANDLE});
    }
    return *this;
}

void Surface::reset() {
    const VkSurfaceKHR surface = std::exchange(surface_, VkSurfaceKHR{VK_NULL_HANDLE});
    if (surface != VK_NULL_HANDLE) vkDestroySurfaceKHR(instance_, surface, nullptr);
}

}  // namespace splice::gpu
