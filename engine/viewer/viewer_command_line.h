// splice-view's options.
#pragma once

#include "engine/capture/capture.h"
#include "engine/vulkan/swapchain.h"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <utility>
#include <vector>

namespace splice {

struct ViewerCommandLine {
    std::vector<std::filesystem::path> inputs;
    RendererOptions renderer;
    bool list_devices = false;
    std::optional<gpu::PresentMode> present_mode;
    std::optional<std::pair<std::uint32_t, std::uint32_t>> size;  // screen coordinates
    std::optional<std::filesystem::path> script, shaders;
    std::optional<std::uint64_t> memory;  // bytes of surfels that are held at most
    std::optional<double> merge_px;       // CaptureSettings::merge_px of what is opened first
};

/// Nothing when --help or --version was asked for and printed. Throws UsageError.
std::optional<ViewerCommandLine> parse_viewer_command_line(int argc, const char* const* argv);

}  // namespace splice
