#include "engine/viewer/interface.h"

#include "preprocess/model_format/error.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_vulkan.h>
#include <imgui.h>
#include <vulkan/vulkan.h>

#include <algorithm>
#include <filesystem>
#include <utility>

namespace splice {

namespace {

constexpr float kFontPixels = 15;
// Debian's fonts-dejavu-core; without it ImGui's built-in font serves.
constexpr const char* kFont = "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf";

void set_style(float scale) {
    ImGuiStyle& style = ImGui::GetStyle();
    style = ImGuiStyle();
    ImGui::StyleColorsDark(&style);
    style.WindowRounding = 0;
    style.FrameRounding = 3;
    style.GrabRounding = 3;
    style.WindowBorderSize = 0;
    style.ItemSpacing = {8, 5};
    style.Colors[ImGuiCol_WindowBg] = {0.11F, 0.12F, 0.13F, 1};
    style.ScaleAllSizes(scale);
}

void check_imgui(VkResult result) {
    // Called from within the library, for results that it does not look at itself; the frame's own calls fail next.
    if (result != VK_SUCCESS && result != VK_ERROR_DEVICE_LOST) gpu::check(result, "drawing the interface");
}

}  // namespace

Interface::Interface(Window& window) : window_(window) {
    IMGUI_CHECKVERSION();
    ImGui::CreateContext();
    ImGuiIO& io = ImGui::GetIO();
    io.IniFilename = nullptr;
    io.LogFilename = nullptr;
    ImGui_ImplGlfw_InitForVulkan(window.handle(), false);
    set_scale(window.content_scale());
}

Interface::~Interface() {
    ImGui_ImplGlfw_Shutdown();
    ImGui::DestroyContext();
}

bool Interface::set_scale(double scale) {
    if (scale == scale_) return false;
    scale_ = scale;
    const auto factor = static_cast<float>(scale);
    set_style(factor);
    ImFontAtlas& fonts = *ImGui::GetIO().Fonts;
    fonts.Clear();
    if (std::error_code status; std::filesystem::exists(kFont, status)) {
        fonts.AddFontFromFileTTF(kFont, kFontPixels * factor);
    } else {
        ImFontConfig config;
        config.SizePixels = 13 * factor;  // the only size that it was drawn for, times whole numbers
        fonts.AddFontDefault(&config);
    }
    unsigned char* texels = nullptr;
    int width = 0, height = 0;
    fonts.GetTexDataAsRGBA32(&texels, &width, &height);
    return true;
}

void Interface::handle(const InputEvent& event) {
    ImGuiIO& io = ImGui::GetIO();
    switch (event.kind) {
        case InputEvent::Kind::kCursor:
            cursor_x_ = event.x;
            cursor_y_ = event.y;
            break;
        case InputEvent::Kind::kButton:
            cursor_x_ = event.x;
            cursor_y_ = event.y;
            if (event.code >= 0 && event.code < 3) buttons_[event.code] = event.pressed;
            break;
        case InputEvent::Kind::kWheel:
            io.MouseWheelH += static_cast<float>(event.x);
            io.MouseWheel += static_cast<float>(event.y);
            break;
        case InputEvent::Kind::kKey:
            if (event.code >= 0 && event.code < 512) io.KeysDown[event.code] = event.pressed;
            io.KeyShift = (event.modifiers & kShift) != 0;
            io.KeyCtrl = (event.modifiers & kControl) != 0;
            io.KeyAlt = (event.modifiers & kAlt) != 0;
            break;
        case InputEvent::Kind::kText:
            io.AddInputCharacter(static_cast<unsigned int>(event.code));
            break;
        case InputEvent::Kind::kFocus:
            // What is let go elsewhere is not seen here.
            std::fill(std::begin(buttons_), std::end(buttons_), false);
            std::fill(std::begin(io.KeysDown), std::end(io.KeysDown), false);
            break;
        case InputEvent::Kind::kDrop:
            break;
    }
}

bool Interface::wants_mouse() const {
    return ImGui::GetIO().WantCaptureMouse;
}

bool Interface::wants_keyboard() const {
    return ImGui::GetIO().WantTextInput;
}

void Interface::begin_frame() {
    ImGuiIO& io = ImGui::GetIO();
    // The library's own step asks the display for what events have told already, which is to wait until it has shown
    // the last frame. Needed where the cursor's shape may change, and once after.
    const bool wanted = std::exchange(wanted_, io.WantCaptureMouse || io.WantCaptureKeyboard);
    if (wanted || wanted_ || !begun_) ImGui_ImplGlfw_NewFrame();
    const VkExtent2D size = window_.size(), pixels = window_.pixels();
    io.DisplaySize = {static_cast<float>(size.width), static_cast<float>(size.height)};
    if (size.width > 0 && size.height > 0)
        io.DisplayFramebufferScale = {static_cast<float>(pixels.width) / io.DisplaySize.x,
                                      static_cast<float>(pixels.height) / io.DisplaySize.y};
    const double now = Window::now();
    constexpr double kShortest = 1e-4, kLongest = 1;  // seconds a frame, as the library counts
    io.DeltaTime = static_cast<float>(std::clamp(now - frame_at_, kShortest, kLongest));
    frame_at_ = now;
    begun_ = true;
    // Where the cursor is comes from the events, scripted ones included, not from the desktop.
    io.MousePos = {static_cast<float>(cursor_x_), static_cast<float>(cursor_y_)};
    std::copy(std::begin(buttons_), std::end(buttons_), io.MouseDown);
    ImGui::NewFrame();
}

void Interface::end_frame() {
    ImGui::Render();
}

InterfaceDrawing::InterfaceDrawing(gpu::Device& device) : device_(device) {
    const VkDescriptorPoolSize size{VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, 1};
    VkDescriptorPoolCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO;
    info.flags = VK_DESCRIPTOR_POOL_CREATE_FREE_DESCRIPTOR_SET_BIT;
    info.maxSets = 1;
    info.poolSizeCount = 1;
    info.pPoolSizes = &size;
    VkDescriptorPool pool = VK_NULL_HANDLE;
    gpu::check(vkCreateDescriptorPool(device.handle(), &info, nullptr, &pool), "creating the interface's descriptors");
    pool_ = gpu::UniqueDescriptorPool(device.handle(), pool);
}

InterfaceDrawing::~InterfaceDrawing() {
    shut_down();
}

void InterfaceDrawing::shut_down() {
    if (!render_pass_) return;
    vkDeviceWaitIdle(device_.handle());
    ImGui_ImplVulkan_Shutdown();
    render_pass_.reset();
    vkResetDescriptorPool(device_.handle(), pool_.get(), 0);
}

void InterfaceDrawing::draw(const graph::PassContext& context) {
    const std::shared_ptr<const gpu::UniqueRenderPass> owner = *context.render_pass_owner;
    if (owner == render_pass_ && !fonts_missing_) {
        ImGui_ImplVulkan_RenderDrawData(ImGui::GetDrawData(), context.commands);
        return;
    }
    shut_down();
    ImGui_ImplVulkan_InitInfo info{};
    info.Instance = device_.instance().handle();
    info.PhysicalDevice = device_.physical();
    info.Device = device_.handle();
    info.QueueFamily = device_.queue_family();
    info.Queue = device_.queue();
    info.PipelineCache = device_.pipeline_cache();
    info.DescriptorPool = pool_.get();
    info.Subpass = context.subpass;
    info.MinImageCount = 2;
    info.ImageCount = 2;
    info.MSAASamples = context.samples;
    info.CheckVkResultFn = check_imgui;
    ImGui_ImplVulkan_Init(&info, context.render_pass);
    render_pass_ = owner;
    fonts_missing_ = true;
}

bool InterfaceDrawing::prepare() {
    if (!fonts_missing_) return false;
    device_.submit_and_wait([](VkCommandBuffer commands) { ImGui_ImplVulkan_CreateFontsTexture(commands); });
    ImGui_ImplVulkan_DestroyFontUploadObjects();
    fonts_missing_ = false;
    return true;
}

}  // namespace splice
