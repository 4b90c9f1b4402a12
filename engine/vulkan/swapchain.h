// The images that a window shows in turns. One frame at a time: acquire, submit and wait, present.
//
//   if (!swapchain.fits(window_size)) swapchain.recreate(window_size, PresentMode::fifo);
//   if (const auto image = swapchain.acquire()) {
//       device.submit_and_wait(record, swapchain.semaphores(VK_PIPELINE_STAGE_TRANSFER_BIT));
//       swapchain.present();
//   }
#pragma once

#include "engine/vulkan/device.h"
#include "engine/vulkan/handle.h"

#include <vulkan/vulkan_core.h>

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

namespace splice::gpu {

/// fifo waits for the display and never tears; relaxed tears when late; mailbox replaces what waits; immediate tears.
enum class PresentMode { fifo, relaxed, mailbox, immediate };

struct PresentModeName {
    PresentMode mode;
    VkPresentModeKHR vulkan;
    std::string_view name;
};
inline constexpr std::array<PresentModeName, 4> kPresentModeNames{
    {{PresentMode::fifo, VK_PRESENT_MODE_FIFO_KHR, "fifo"},
     {PresentMode::relaxed, VK_PRESENT_MODE_FIFO_RELAXED_KHR, "relaxed"},
     {PresentMode::mailbox, VK_PRESENT_MODE_MAILBOX_KHR, "mailbox"},
     {PresentMode::immediate, VK_PRESENT_MODE_IMMEDIATE_KHR, "immediate"}}};

std::optional<PresentMode> present_mode_of_name(std::string_view name);

/// Whether nothing can be shown on it any more: where it is new, its window is gone.
bool is_lost(const Device& device, VkSurfaceKHR surface);

class Swapchain {
  public:
    /// The device was opened for the surface; both must outlive the swapchain. Has no images before recreate().
    Swapchain(Device& device, VkSurfaceKHR surface);
    Swapchain(const Swapchain&) = delete;
    Swapchain& operator=(const Swapchain&) = delete;
    ~Swapchain();

    /// For a window of so many pixels. A mode that the surface lacks becomes fifo, which all have. Nothing is made, and
    /// false returned, while the window has no area. Throws DeviceError, SurfaceLostError.
    bool recreate(VkExtent2D window, PresentMode mode);
    /// Whether there are images, of that size, and presenting did not find them out of date.
    bool fits(VkExtent2D window) const;

    /// Throws SurfaceLostError where the window is gone, which nothing else says while nothing is shown.
    void check_surface() const { capabilities(); }

    /// The index of the image to draw next; nothing: recreate and try again.
    std::optional<uint32_t> acquire();
    /// For the submission that draws the acquired image; the stages are those that touch it first.
    SubmitSemaphores semaphores(VkPipelineStageFlags first_stages) const;
    /// Shows the acquired image, which must be in PRESENT_SRC_KHR.
    void present();

    VkFormat format() const { return format_.format; }
    VkExtent2D extent() const { return extent_; }
    VkImageUsageFlags usage() const { return usage_; }
    PresentMode mode() const { return mode_; }
    VkImage image(uint32_t index) const { return images_[index]; }
    VkImageView view(uint32_t index) const { return views_[index].get(); }

  private:
    VkSurfaceCapabilitiesKHR capabilities() const;
    void choose_format();
    void create(const VkSurfaceCapabilitiesKHR& capabilities);
    void create_images();

    Device& device_;
    VkSurfaceKHR surface_;
    VkSurfaceFormatKHR format_{};
    VkExtent2D window_{};  // that the images were made for
    VkExtent2D extent_{};
    VkImageUsageFlags usage_ = 0;
    PresentMode mode_ = PresentMode::fifo;
    UniqueSwapchain swapchain_;
    std::vector<VkImage> images_;
    std::vector<UniqueImageView> views_;
    UniqueSemaphore acquired_;
    std::vector<UniqueSemaphore> drawn_;  // one an image: presenting may still wait for the last one's
    uint32_t current_ = 0;
    bool out_of_date_ = true;
};

}  // namespace splice::gpu
