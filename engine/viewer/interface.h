// Dear ImGui in the window: its context, its input from the viewer's events, and its drawing as a pass of the window's
// render graph.
#pragma once

#include "engine/render_graph/executor/pass_context.h"
#include "engine/viewer/input.h"
#include "engine/viewer/window.h"
#include "engine/vulkan/descriptor.h"
#include "engine/vulkan/device.h"

#include <memory>

namespace splice {

/// The panels' side: one a process, lives through lost devices.
class Interface {
  public:
    explicit Interface(Window& window);
    Interface(const Interface&) = delete;
    Interface& operator=(const Interface&) = delete;
    ~Interface();

    /// Hands events on. At most one button or key that changes in a frame, so that none is missed.
    void handle(const InputEvent& event);
    /// Whether the cursor is over a panel, or the keyboard types into one.
    bool wants_mouse() const;
    bool wants_keyboard() const;

    /// Fonts and sizes for a monitor; true if they changed, which asks for a new InterfaceDrawing.
    bool set_scale(double scale);
    void begin_frame();
    void end_frame();

  private:
    Window& window_;
    double scale_ = 0;
    double cursor_x_ = -1, cursor_y_ = -1;
    bool buttons_[3] = {};
    bool begun_ = false;
    bool wanted_ = false;  // the last frame's mouse or keyboard
    double frame_at_ = 0;  // seconds; the last frame
};

/// The device's side.
class InterfaceDrawing {
  public:
    explicit InterfaceDrawing(gpu::Device& device);
    InterfaceDrawing(const InterfaceDrawing&) = delete;
    InterfaceDrawing& operator=(const InterfaceDrawing&) = delete;
    ~InterfaceDrawing();

    /// Inside the pass. Pipelines are made for the pass's render pass when it is new; then nothing is drawn until
    /// prepare() was called.
    void draw(const graph::PassContext& context);
    /// Outside of frames: what draw() found missing. True if there was something, so that the frame is to be repeated.
    bool prepare();

  private:
    void shut_down();

    gpu::Device& device_;
    gpu::UniqueDescriptorPool pool_;
    std::shared_ptr<const gpu::UniqueRenderPass> render_pass_;  // that the pipelines are for
    bool fonts_missing_ = false;
};

}  // namespace splice
