// The window's own frame, a render graph: pictures are copied to the window's image, and the interface is drawn over
// them. As long as the interface is the same and covers nothing but the panels, these are copied, too: on a software
// device, to draw them takes as long as a picture in motion.
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
#include <optional>
#include <vector>

namespace splice {

/// Pixels; the upper left corner, and width and height.
struct PixelRect {
    std::int32_t x = 0, y = 0, width = 0, height = 0;
    friend bool operator==(const PixelRect&, const PixelRect&) = default;
};

struct ShownPicture {
    const gpu::Image* image = nullptr;  // in TRANSFER_SRC_OPTIMAL
    PixelRect source;                   // of the image
    PixelRect destination;              // of the window; scaled where the sizes differ
};

/// The interface over the pictures.
struct ShownInterface {
    std::function<void(const graph::PassContext&)> draw;
    std::vector<PixelRect> panels;  // of the window: parts that it covers
    bool only_panels = false;       // it draws nothing elsewhere
    std::uint64_t revision = 0;     // another number: it may look different
};

/// The window as it is shown, for screenshots: sRGB-encoded RGBA, rows top to bottom.
struct WindowPixels {
    std::uint32_t width = 0, height = 0;
    std::vector<std::uint8_t> rgba;
};

class Presenter {
  public:
    Presenter(gpu::Device& device, VkSurfaceKHR surface, gpu::PresentMode mode);

    gpu::PresentMode mode() const { return swapchain_.mode(); }

    /// Throws SurfaceLostError where the window is gone.
    void check_surface() const { swapchain_.check_surface(); }

    /// One frame in a window of so many pixels; what no picture covers is grey where there are no pictures, else
    /// undefined. False if nothing could be shown (no area, or the window changed meanwhile): try again later. With
    /// `pixels`, what is shown is read back, too.
    bool present(VkExtent2D window, const std::vector<ShownPicture>& pictures, const ShownInterface& interface,
                 WindowPixels* pixels = nullptr);
    /// The last frame's interface was not what it should be: draw it anew.
    void forget_interface() { kept_.revision.reset(); }

    std::uint64_t objects_created() const { return executor_.statistics().objects_created; }

  private:
    /// The panels as they were drawn last, where they are in the window.
    struct KeptInterface {
        gpu::Image image;  // of the window's size; between frames in TRANSFER_SRC_OPTIMAL, once it holds anything
        std::vector<PixelRect> panels;
        std::optional<std::uint64_t> revision;  // none: nothing is kept
    };

    bool reads_window() const { return (swapchain_.usage() & VK_IMAGE_USAGE_TRANSFER_SRC_BIT) != 0; }
    graph::ImageHandle declare(const std::vector<ShownPicture>& pictures, const ShownInterface& interface,
                               graph::Bindings& bindings, std::uint32_t image);
    void reserve_kept();
    void keep(const ShownInterface& interface);
    void read_back(graph::ImageHandle image, graph::Bindings& bindings);
    void take_pixels(WindowPixels& pixels) const;

    gpu::Device& device_;
    gpu::Swapchain swapchain_;
    gpu::PresentMode wanted_mode_;
    graph::Graph graph_;
    graph::Executor executor_;
    gpu::Buffer pixels_;
    KeptInterface kept_;
};

}  // namespace splice
