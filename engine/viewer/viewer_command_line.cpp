#include "engine/viewer/viewer_command_line.h"

#include "preprocess/build_model/program_main.h"
#include "preprocess/model_format/error.h"

#include <CLI/CLI.hpp>

#include <charconv>
#include <cmath>

namespace splice {

namespace {

constexpr const char* kAbout = R"(splice-view - a window on hybrid models

Each INPUT is a model file (splice-bake) or a mesh (OBJ, PLY, STL, OFF, SMF), which is baked on the way; or one scene file
(JSON). Without any, drop files on the window.

Left drag orbits, middle or shift-left drag pans, the wheel zooms to the cursor, a double click sets the pivot, F frames
all. docs/viewer.md lists the rest, and the actions of scripts.)";

constexpr const char* kExamples = R"(Examples:
  splice-view bunny.splice
  splice-view scenes/gallery.json --device cpu
  splice-view dragon.ply --script tour.txt

Exit status: 0 closed; 1 the input, the display or the device failed; 2 wrong usage.)";

std::pair<std::uint32_t, std::uint32_t> parse_window_size(const std::string& text) {
    const auto fail = [&]() -> std::uint32_t {
        throw UsageError("--size: expected WIDTHxHEIGHT from 1x1 to 16384x16384 like 1280x720, got \"" + text + "\"");
    };
    const std::size_t cross = text.find('x');
    if (cross == std::string::npos) fail();
    const auto side = [&](std::string_view digits) {
        std::uint32_t value = 0;
        const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
        const bool whole = error == std::errc() && end == digits.data() + digits.size();
        return whole && value > 0 && value <= 16384 ? value : fail();
    };
    return {side(std::string_view(text).substr(0, cross)), side(std::string_view(text).substr(cross + 1))};
}

gpu::PresentMode parse_present_mode(const std::string& text) {
    if (const auto mode = gpu::present_mode_of_name(text)) return *mode;
    throw UsageError("--present-mode: expected fifo, relaxed, mailbox or immediate, got \"" + text + "\"");
}

}  // namespace

std::optional<ViewerCommandLine> parse_viewer_command_line(int argc, const char* const* argv) {
    ViewerCommandLine command;
    std::string size, present_mode, script, shaders;
    double megabytes = 0;  // 0: all
    double merge_px = -1;  // less than 0: not given
    std::vector<std::string> inputs;
    CLI::App app(kAbout, "splice-view");
    app.footer(kExamples);
    app.set_version_flag("--version", "splice-view " SPLICE_VERSION);
    app.add_option("INPUT", inputs, "Models and meshes, or one scene");
    app.add_option("--device", command.renderer.device,
                   "auto: a GPU if there is one, else lavapipe; cpu; or a number of --list-devices")
        ->option_text("auto|cpu|INDEX");
    app.add_flag("--list-devices", command.list_devices, "Print the Vulkan devices and exit");
    app.add_option("--size", size, "Of the window, default as left last time, else 1280x720")->option_text("WxH");
    app.add_option("--present-mode", present_mode,
                   "How images reach the screen: fifo (default; waits for the display, never tears), relaxed, mailbox "
                   "or immediate; fifo where the display lacks it")
        ->option_text("MODE");
    app.add_option(
           "--memory", megabytes,
           "Hold at most so much of surfels; the others stay in the model file and are read as pictures need them")
        ->option_text("MB")
        ->check(CLI::Range(1.0, 1e9));
    app.add_option(
           "--merge", merge_px,
           "Surfels of a patch become fewer where that moves none by more than so many pixels, 0 to 64; default "
           "0.5; 0: every surfel is drawn")
        ->option_text("PIXELS")
        ->check(CLI::Range(0.0, kMostMergePixels));
    app.add_option("--script", script, "Actions to do, one a line (docs/viewer.md); - is standard input")
        ->option_text("FILE");
    app.add_option("--shaders", shaders, "Folder of GLSL sources (shaders/glsl) to compile anew when one changes")
        ->option_text("FOLDER");
    app.add_flag("--validate", command.renderer.validate,
                 "Run with the Vulkan validation layers; any message fails the run at its end");
    if (!parse_command_line(app, argc, argv)) return std::nullopt;
    // No range excludes what compares with nothing.
    for (const auto& [option, value] : {std::pair("--memory", megabytes), std::pair("--merge", merge_px)})
        if (std::isnan(value)) throw UsageError(std::string(option) + ": expected a number, got \"nan\"");
    if (!size.empty()) command.size = parse_window_size(size);
    if (!present_mode.empty()) command.present_mode = parse_present_mode(present_mode);
    if (megabytes > 0) command.memory = static_cast<std::uint64_t>(megabytes * 1024 * 1024);
    if (merge_px >= 0) command.merge_px = merge_px;
    if (!script.empty()) command.script = script;
    if (!shaders.empty()) command.shaders = shaders;
    command.inputs.assign(inputs.begin(), inputs.end());
    return command;
}

}  // namespace splice
