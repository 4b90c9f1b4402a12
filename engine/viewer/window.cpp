#include "engine/viewer/window.h"

#include "engine/viewer/x_errors.h"
#include "engine/vulkan/handle.h"
#include "preprocess/model_format/error.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <vulkan/vulkan.h>

#include <algorithm>
#include <cmath>

namespace splice {

namespace {

std::string last_error() {
    const char* text = nullptr;
    return glfwGetError(&text) == GLFW_NO_ERROR || text == nullptr ? "unknown reason" : text;
}

VkExtent2D extent_of(int width, int height) {
    return {static_cast<std::uint32_t>(std::max(width, 0)), static_cast<std::uint32_t>(std::max(height, 0))};
}

}  // namespace

// GLFW's modifier bits are those of Modifiers; its keys and buttons pass as they are.
struct Window::Callbacks {
    static Window& of(GLFWwindow* window) { return *static_cast<Window*>(glfwGetWindowUserPointer(window)); }
    static InputEvent& add(GLFWwindow* window, InputEvent::Kind kind) {
        InputEvent event;
        event.kind = kind;
        event.time = now();
        return of(window).events_.emplace_back(std::move(event));
    }
    static void cursor(GLFWwindow* window, double x, double y) {
        // Only the last of several moves in a row matters.
        InputQueue& events = of(window).events_;
        const bool again = !events.empty() && events.back().kind == InputEvent::Kind::kCursor;
        InputEvent& event = again ? events.back() : add(window, InputEvent::Kind::kCursor);
        event.x = x;
        event.y = y;
    }
    static void button(GLFWwindow* window, int button, int action, int modifiers) {
        InputEvent& event = add(window, InputEvent::Kind::kButton);
        glfwGetCursorPos(window, &event.x, &event.y);
        event.code = button;
        event.pressed = action == GLFW_PRESS;
        event.modifiers = modifiers;
    }
    static void wheel(GLFWwindow* window, double x, double y) {
        InputEvent& event = add(window, InputEvent::Kind::kWheel);
        event.x = x;
        event.y = y;
    }
    static void key(GLFWwindow* window, int key, int scancode, int action, int modifiers) {
        InputEvent& event = add(window, InputEvent::Kind::kKey);
        event.code = key;
        event.scancode = scancode;
        event.pressed = action != GLFW_RELEASE;
        event.repeated = action == GLFW_REPEAT;
        event.modifiers = modifiers;
    }
    static void text(GLFWwindow* window, unsigned int code_point) {
        add(window, InputEvent::Kind::kText).code = static_cast<int>(code_point);
    }
    static void drop(GLFWwindow* window, int count, const char** paths) {
        InputEvent& event = add(window, InputEvent::Kind::kDrop);
        for (int i = 0; i < count; ++i)
            event.files.emplace_back(paths[i]);
    }
    static void focus(GLFWwindow* window, int gained) {
        add(window, InputEvent::Kind::kFocus).pressed = gained == GLFW_TRUE;
    }
    static void refresh(GLFWwindow* window) { of(window).damaged_ = true; }
    static void pixels(GLFWwindow* window, int width, int height) {
        of(window).pixels_ = extent_of(width, height);
        of(window).damaged_ = true;
    }
    static void size(GLFWwindow* window, int width, int height) {
        of(window).size_ = extent_of(width, height);
        of(window).damaged_ = true;
    }
    static void iconify(GLFWwindow* window, int minimised) {
        of(window).minimised_ = minimised == GLFW_TRUE;
        of(window).damaged_ = true;
    }
    static void scale(GLFWwindow* window, float x, float y) {
        of(window).content_scale_ = std::max({x, y, 1.0F});
        of(window).damaged_ = true;
    }
};

Window::Window(const WindowOptions& options) : title_(options.title) {
    constexpr const char* advice = "; splice-capture renders without a window";
    if (glfwInit() == GLFW_FALSE) throw SystemError("no display to open a window on: " + last_error() + advice);
    ignore_missing_windows();
    try {
        if (glfwVulkanSupported() == GLFW_FALSE)
            throw SystemError("this display has no Vulkan: " + last_error() + advice);
        glfwWindowHint(GLFW_CLIENT_API, GLFW_NO_API);
        glfwWindowHint(GLFW_SCALE_TO_MONITOR, GLFW_TRUE);
        window_ = glfwCreateWindow(static_cast<int>(options.width), static_cast<int>(options.height), title_.c_str(),
                                   nullptr, nullptr);
        if (window_ == nullptr) throw SystemError("cannot open a window: " + last_error() + advice);
    } catch (...) {
        glfwTerminate();
        throw;
    }
    glfwSetWindowUserPointer(window_, this);
    glfwSetCursorPosCallback(window_, Callbacks::cursor);
    glfwSetMouseButtonCallback(window_, Callbacks::button);
    glfwSetScrollCallback(window_, Callbacks::wheel);
    glfwSetKeyCallback(window_, Callbacks::key);
    glfwSetCharCallback(window_, Callbacks::text);
    glfwSetDropCallback(window_, Callbacks::drop);
    glfwSetWindowContentScaleCallback(window_, Callbacks::scale);
    glfwSetWindowFocusCallback(window_, Callbacks::focus);
    glfwSetWindowRefreshCallback(window_, Callbacks::refresh);
    glfwSetFramebufferSizeCallback(window_, Callbacks::pixels);
    glfwSetWindowSizeCallback(window_, Callbacks::size);
    glfwSetWindowIconifyCallback(window_, Callbacks::iconify);
    float x = 1, y = 1;
    glfwGetWindowContentScale(window_, &x, &y);
    Callbacks::scale(window_, x, y);
    int width = 0, height = 0;
    glfwGetFramebufferSize(window_, &width, &height);
    Callbacks::pixels(window_, width, height);
    glfwGetWindowSize(window_, &width, &height);
    Callbacks::size(window_, width, height);
    Callbacks::iconify(window_, glfwGetWindowAttrib(window_, GLFW_ICONIFIED));
}

Window::~Window() {
    glfwDestroyWindow(window_);
    glfwTerminate();
}

std::vector<std::string> Window::instance_extensions() const {
    std::uint32_t count = 0;
    const char** names = glfwGetRequiredInstanceExtensions(&count);
    if (names == nullptr) throw SystemError("this display has no Vulkan: " + last_error());
    return {names, names + count};
}

gpu::Surface Window::create_surface(const gpu::Instance& instance) const {
    VkSurfaceKHR surface = VK_NULL_HANDLE;
    gpu::check(glfwCreateWindowSurface(instance.handle(), window_, nullptr, &surface),
               "preparing the window for Vulkan");
    return {instance, surface};
}

bool Window::wants_to_close() const {
    return glfwWindowShouldClose(window_) == GLFW_TRUE;
}

void Window::close() {
    glfwSetWindowShouldClose(window_, GLFW_TRUE);
}

void Window::set_title(const std::string& title) {
    if (title == title_) return;
    title_ = title;
    glfwSetWindowTitle(window_, title.c_str());
}

void Window::resize(std::uint32_t width, std::uint32_t height) {
    glfwSetWindowSize(window_, static_cast<int>(width), static_cast<int>(height));
}

void Window::minimise() {
    glfwIconifyWindow(window_);
}

void Window::restore() {
    glfwRestoreWindow(window_);
}

void Window::hide() {
    glfwHideWindow(window_);
    glfwPollEvents();
}

VkExtent2D Window::unscaled_size() const {
    float x = 1, y = 1;
    glfwGetWindowContentScale(window_, &x, &y);
    const auto unscaled = [](std::uint32_t size, float scale) {
        return static_cast<std::uint32_t>(std::lround(static_cast<float>(size) / std::max(scale, 0.01F)));
    };
    return {unscaled(size_.width, x), unscaled(size_.height, y)};
}

void Window::set_content_scale(double scale) {
    const auto factor = static_cast<float>(scale);
    Callbacks::scale(window_, factor, factor);
}

void Window::set_clipboard(const std::string& text) {
    glfwSetClipboardString(window_, text.c_str());
}

void Window::wait(double seconds) {
    if (seconds > 0) {
        glfwWaitEventsTimeout(seconds);
    } else {
        glfwPollEvents();
    }
}

double Window::now() {
    return glfwGetTime();
}

}  // namespace splice
