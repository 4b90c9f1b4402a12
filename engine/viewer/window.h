// A window of the desktop, by GLFW: its size, its surface, and what happens in it as a queue of events.
#pragma once

#include "engine/viewer/input.h"
#include "engine/vulkan/instance.h"
#include "engine/vulkan/surface.h"

#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

struct GLFWwindow;

namespace splice {

struct WindowOptions {
    std::uint32_t width = 1280, height = 720;  // screen coordinates
    std::string title = {};
};

/// One a process.
class Window {
  public:
    /// Throws SystemError where there is no display or no Vulkan for it.
    explicit Window(const WindowOptions& options);
    Window(const Window&) = delete;
    Window& operator=(const Window&) = delete;
    ~Window();

    GLFWwindow* handle() const { return window_; }
    std::vector<std::string> instance_extensions() const;
    gpu::Surface create_surface(const gpu::Instance& instance) const;

    // As the last events told: to ask the display would be to wait for it.
    VkExtent2D pixels() const { return minimised_ ? VkExtent2D{0, 0} : pixels_; }  // 0 x 0 while minimised
    VkExtent2D size() const { return size_; }  // in screen coordinates, as cursor positions are
    /// What WindowOptions must say for a window of this size: they are multiplied by the monitor's scale.
    VkExtent2D unscaled_size() const;
    double content_scale() const { return content_scale_; }
    bool wants_to_close() const;
    void close();
    void set_title(const std::string& title);
    void resize(std::uint32_t width, std::uint32_t height);
    void minimise();
    void restore();
    /// For good.
    void hide();
    /// As if the window were on a monitor of another scale from now on.
    void set_content_scale(double scale);
    void set_clipboard(const std::string& text);

    /// Fills events(); waits for one at most so long (0: not at all).
    void wait(double seconds);
    InputQueue& events() { return events_; }
    /// Whether the window has to be drawn again since the last call: uncovered, or of another size.
    bool take_damage() { return std::exchange(damaged_, false); }
    static double now();  // seconds, the clock of the events

  private:
    struct Callbacks;
    GLFWwindow* window_ = nullptr;
    InputQueue events_;
    VkExtent2D pixels_{}, size_{};
    bool minimised_ = false;
    double content_scale_ = 1;
    bool damaged_ = true;
    std::string title_;
};

}  // namespace splice
