// The window's own frame, a render graph of two passes: pictures are copied to the window's image, and the interface is
// drawn over them.
#pragma once

#include "engine/render_graph/executor/executor.h"
#include "engine/render_graph/graph.h"
#include "engine/vulkan/buffer.h"
#include "engine/vulkan/device.h"
#include "engine/vulkan/image.h"
#include "engine/vulkan/surface.h"
#include "engine/vulkan/swapchain.h"

#include <array>
#include <cstdint>
#include <functional>
#include <vector>

namespace splice {

/// Pixels; the upper left corner, and width and height.
struct PixelRect {
    std::int32_t x = 0, y = 0, width = 0, height = 0;
};

struct ShownPicture {
    const gpu::Image* image = nullptr;  // in TRANSFER_SRC_OPTIMAL
    PixelRect source;                   // of the image
    PixelRect destination;              // of the window; scaled where the sizes differ
};

/// The window as it is shown, for screenshots: sRGB-encoded RGBA, rows top to bottom.
struct WindowPixels {
    std::uint32_t width = 0, height = 0;
    std::vector<std::uint8_t> rgba;
};

class Presenter {
  public:
    using DrawInterface = std::function<void(const graph::PassContext&)>;

    Presenter(gpu::Device& device, VkSurfaceKHR surface, gpu::PresentMode mode);

    gpu::PresentMode mode() const { return swapchain_.mode(); }

    /// One frame in a window of so many pixels; what no picture covers is grey where there are no pictures, else
    /// undefined. False if nothing could be shown (no area, or the window changed meanwhile): try again later. With
    /// `pixels`, what is shown is read back, too.
    bool present(VkExtent2D window, const std::vector<ShownPicture>& pictures, const DrawInterface& draw_interface,
                 WindowPixels* pixels = nullptr);

    std::uint64_t objects_created() const { return executor_.statistics().objects_created; }

  private:
    graph::ImageHandle declare(const std::vector<ShownPicture>& pictures, const DrawInterface& draw_interface,
                               graph::Bindings& bindings, std::uint32_t image);
    void read_back(graph::ImageHandle image, graph::Bindings& bindings);
    void take_pixels(WindowPixels& pixels) const;

    gpu::Device& device_;
    gpu::Swapchain swapchain_;
    gpu::PresentMode wanted_mode_;
    graph::Graph graph_;
    graph::Executor executor_;
    gpu::Buffer pixels_;
};

}  // namespace splice
