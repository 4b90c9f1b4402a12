// What commands do, whether a panel, a key or a script gives them.
#include "engine/capture/png_file.h"
#include "engine/viewer/capture_line.h"
#include "engine/viewer/process_memory.h"
#include "engine/viewer/settings_file.h"
#include "engine/viewer/viewer.h"
#include "preprocess/model_format/atomic_file.h"
#include "preprocess/model_format/error.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <iostream>
#include <map>
#include <numeric>
#include <thread>
#include <utility>

namespace splice {

namespace {

template <typename Value, std::size_t N>
Value named(const Names<Value, N>& names, const std::string& name, const std::string& what) {
    if (const auto known = find_named(names, name)) return *known;
    throw UsageError(what + ": expected one of " + listed(names) + ", got \"" + name + "\"");
}

bool on_or_off(const std::string& what, const std::string& value) {
    if (value == "on" || value == "off") return value == "on";
    throw UsageError(what + ": expected on or off, got \"" + value + "\"");
}

constexpr Names<ForcedRepresentation, 3> kBakes{{{ForcedRepresentation::kHybrid, "hybrid"},
                                                 {ForcedRepresentation::kTriangles, "triangles"},
                                                 {ForcedRepresentation::kSurfels, "surfels"}}};

}  // namespace

Viewer::Viewer(const ViewerCommandLine& command)
    : options_(command),
      window_([&] {
          const ViewerSettings settings = command.script ? ViewerSettings{} : read_settings();
          WindowOptions window{.title = "splice-view"};
          window.width = command.size ? command.size->first : settings.width;
          window.height = command.size ? command.size->second : settings.height;
          return window;
      }()),
      instance_({.application = "splice-view",
                 .validate = command.renderer.validate,
                 .extensions = window_.instance_extensions()}),
      interface_(window_) {
    note_start("window opened");
    if (command.script) script_ = read_script(*command.script);
    // What draws fastest where it runs; splice-capture's default is the reference.
    for (CaptureSettings& look : state_.looks)
        look.backend = Backend::kAuto;
    state_.looks[1].shown = Shown::kTriangles;
    // Scripts do the same for everybody.
    if (!command.script) apply_settings(read_settings(), state_);
    if (command.present_mode) state_.present_mode = *command.present_mode;
    if (command.shaders) shaders_.emplace(*command.shaders);
    graphics_.emplace(window_, instance_, command.renderer.device, state_.present_mode);
    note_start("device opened");
    if (!command.inputs.empty()) {
        // As most models are shown, while they are read.
        graphics_->renderer->make_for(state_.looks[0], Lighting{});
        open(command.inputs, false);
    }
    redraw_ = 1;
}

void Viewer::report(const std::string& text, bool error) {
    if (text.empty()) return;
    (error ? std::cerr : std::cout) << "splice-view: " << text << std::endl;
    constexpr std::size_t most = 6;
    if (state_.messages.size() >= most) state_.messages.erase(state_.messages.begin());
    state_.messages.push_back({text, error});
    redraw_ = kFramesToSettle;
}

std::filesystem::path Viewer::first_input() const {
    return state_.scene->paths.front();
}

CaptureSettings Viewer::full_settings(std::size_t look) const {
    CaptureSettings settings = state_.looks[look];
    const Viewport viewport = area(look).size;
    settings.camera = state_.camera.camera();
    settings.width = viewport.width;
    settings.height = viewport.height;
    return settings;
}

void Viewer::open(std::vector<std::filesystem::path> paths, bool again) {
    SceneRequest request{std::move(paths), {}, again};
    // One core stays with the window.
    request.options.threads = static_cast<int>(std::max(std::thread::hardware_concurrency(), 2U) - 1);
    if (again) request.options.bake = state_.bake;
    job_ = std::make_unique<SceneJob>(std::move(request));
}

void Viewer::save_scene(const std::filesystem::path& path) {
    SceneDescription description = state_.scene->loaded.description;
    for (SceneModel& model : description.models)
        if (auto* file = std::get_if<std::filesystem::path>(&model.source)) *file = std::filesystem::absolute(*file);
    const CaptureSettings settings = full_settings(state_.edited_look);
    description.camera = settings.camera;
    description.lighting = state_.scene->loaded.scene.lighting;
    description.background = state_.scene->loaded.scene.background;
    description.width = settings.width;
    description.height = settings.height;
    description.view = settings.view;
    description.sides = settings.sides;
    description.epsilon_scale = settings.epsilon_scale;
    description.prefilter = settings.prefilter;
    description.shading = settings.shading;
    description.antialias = settings.antialias;
    description.tau = settings.tau;
    description.kernel = settings.kernel;
    write_text_file(path, write_scene(description, std::filesystem::absolute(path).parent_path()));
    report("Wrote " + path.string(), false);
}

void Viewer::go_to(const std::string& name) {
    for (const CameraBookmark& bookmark : state_.scene->loaded.description.bookmarks)
        if (bookmark.name == name) return state_.camera.set_camera(bookmark.camera);
    throw UsageError("no bookmark \"" + name + "\"");
}

void Viewer::write_statistics(const std::filesystem::path& path) {
    const CutStats& cut = measured_.stats.cut;
    nlohmann::ordered_json start;
    for (const auto& [step, seconds] : start_steps_)
        start[step] = seconds;
    nlohmann::ordered_json passes;
    for (const PassHistory::Series& pass : measured_.history.series())
        passes[pass.name] = std::accumulate(pass.ms.begin(), pass.ms.end(), 0.0) / PassHistory::kFrames;
    const ProcessMemory memory = process_memory();
    const PageStats& pages = measured_.stats.pages;
    const nlohmann::ordered_json json{{"first_picture_s", state_.first_picture_s},
                                      {"start_s", start},
                                      {"frames", frame_times_.count()},
                                      {"frames_per_second", frame_times_.frames_per_second()},
                                      {"median_frame_ms", frame_times_.median_ms()},
                                      {"median_panels_ms", panel_times_.median_ms()},
                                      {"median_pictures_ms", picture_times_.median_ms()},
                                      {"median_show_ms", show_times_.median_ms()},
                                      {"drawn", {measured_.drawn_width, measured_.drawn_height}},
                                      {"picture_ms", measured_.stats.frame_ms},
                                      {"mean_pass_ms", passes},
                                      {"tau", cut.tau},
                                      {"surfels_drawn", measured_.stats.surfels_drawn},
                                      {"triangles_drawn", measured_.stats.triangles_drawn},
                                      {"select_ms", cut.select_ms},
                                      {"pages",
                                       {{"limit_bytes", pages.limit_bytes},
                                        {"resident_bytes", pages.resident_bytes},
                                        {"blocks_read", pages.blocks_read},
                                        {"missing_surfels", pages.missing_surfels}}},
                                      {"device_bytes", measured_.device_bytes},
                                      {"heap_bytes", memory.heap_bytes},
                                      {"resident_bytes", memory.resident_bytes},
                                      {"open_files", memory.open_files}};
    write_text_file(path, json.dump(2) + "\n");
    for (FrameTimes* times : {&frame_times_, &panel_times_, &picture_times_, &show_times_})
        times->clear();
}

void Viewer::set_value(const std::string& name, const std::string& value) {
    CaptureSettings& look = state_.looks[state_.edited_look];
    const auto number = [&](double least, double most) {
        const double parsed = Command{name, {value}}.number(0);
        const bool is_number = !value.empty() && value.find_first_not_of("0123456789.eE+-") == std::string::npos;
        if (!is_number || parsed < least || parsed > most)
            throw UsageError("set " + name + ": expected a number from " + std::to_string(least) + " to " +
                             std::to_string(most) + ", got \"" + value + "\"");
        return parsed;
    };
    const std::map<std::string, std::function<void()>> settings{
        {"view", [&] { look.view = named(kViewNames, value, "set view"); }},
        {"show", [&] { look.shown = named(kShownNames, value, "set show"); }},
        {"backend", [&] { look.backend = named(kBackendNames, value, "set backend"); }},
        {"shading", [&] { look.shading = named(kShadingNames, value, "set shading"); }},
        {"sides", [&] { look.sides = named(kSidesNames, value, "set sides"); }},
        {"epsilon", [&] { look.epsilon_scale = number(0, 100); }},
        {"prefilter", [&] { look.prefilter = on_or_off("set prefilter", value); }},
        {"antialias",
         [&] {
             const double samples = number(1, kMostSamplesPerSide);
             if (samples != std::floor(samples)) throw UsageError("set antialias: expected a whole number");
             look.antialias = static_cast<std::uint32_t>(samples);
         }},
        {"tau", [&] { look.tau = number(0, kMostTau); }},
        {"budget", [&] { state_.moving_budget_ms = number(1, 1000); }},
        {"freeze", [&] { state_.freeze_cut = on_or_off("set freeze", value); }},
        {"kernel",
         [&] {
             const std::optional<Kernel> kernel = parse_kernel(value);
             if (!kernel) throw UsageError("set kernel: there is no kernel \"" + value + "\" (docs/viewer.md)");
             look.kernel = *kernel;
         }},
        {"edited", [&] { state_.edited_look = value == "right" && pictures() == 2 ? 1 : 0; }},
        {"wipe", [&] { state_.wipe = number(0, 1); }},
        {"coarser", [&] { state_.reduce_while_moving = on_or_off("set coarser", value); }},
        {"graph", [&] { state_.graph_window = on_or_off("set graph", value); }},
        {"bake", [&] { state_.bake.cluster.representation = named(kBakes, value, "set bake"); }},
        {"triangle-share", [&] { state_.bake.cluster.triangle_share = number(0, 1); }},
        {"spacing",
         [&] {
             state_.bake.sampling.h_max = number(1e-4, 1);
             state_.bake.sampling.h_min = std::min(SamplingOptions{}.h_min, state_.bake.sampling.h_max);
         }},
        {"background",
         [&] {
             const auto colour = parse_colour(value);
             if (!colour && value != "transparent") throw UsageError("set background: expected a colour");
             if (!state_.scene) return;
             state_.scene->loaded.scene.background = {colour.value_or(glm::dvec3(1)), value == "transparent"};
             ++state_.scene_revision;
         }},
    };
    const auto setting = settings.find(name);
    if (setting == settings.end()) throw UsageError("set: there is no \"" + name + "\" (docs/viewer.md)");
    setting->second();
}

void Viewer::run_command(const Command& command) {
    const std::string& name = command.name;
    const auto& arguments = command.arguments;
    const auto need_scene = [&] {
        if (!state_.scene) throw UsageError(name + ": nothing is open");
    };
    const std::map<std::string, std::function<void()>> commands{
        {"open",
         [&] {
             open({arguments.begin(), arguments.end()}, false);
         }},
        {"resize",
         [&] {
             window_.resize(static_cast<std::uint32_t>(command.number(0)),
                            static_cast<std::uint32_t>(command.number(1)));
         }},
        {"minimise", [&] { window_.minimise(); }},
        {"restore", [&] { window_.restore(); }},
        {"monitor-scale",
         [&] {
             const double scale = command.number(0);
             if (scale < 1 || scale > 4) throw UsageError("monitor-scale: expected a number from 1 to 4");
             window_.set_content_scale(scale);
         }},
        {"view", [&] { set_value("view", arguments[0]); }},
        {"next-view",
         [&] {
             View& view = state_.looks[state_.edited_look].view;
             const std::size_t count = kViewNames.size();
             const std::size_t step = command.number(0) < 0 ? count - 1 : 1;
             view = kViewNames[(static_cast<std::size_t>(view) + step) % count].value;
         }},
        {"set", [&] { set_value(arguments[0], arguments[1]); }},
        {"compare", [&] { state_.comparison = named(kComparisonNames, arguments[0], "compare"); }},
        {"panels", [&] { state_.panels = on_or_off("panels", arguments[0]); }},
        {"rebake",
         [&] {
             need_scene();
             if (!state_.scene->bakeable) throw UsageError("only meshes and shapes can be baked anew");
             open(state_.scene->paths, true);
         }},
        {"screenshot",
         [&] {
             need_scene();
             const CaptureSettings settings = full_settings(state_.edited_look);
             Frame frame = graphics_->renderer->render(state_.scene->loaded.scene, settings);
             write_png(arguments[0], {frame.width, frame.height, std::move(frame.rgba)});
             report("Wrote " + arguments[0], false);
         }},
        {"screenshot-window",
         [&] {
             moved_at_ = -1e9;
             draw_pictures();
             WindowPixels pixels;
             // Twice where the window changed, or fonts were missing.
             for (int i = 0; i < 4 && !show_window(&pixels); ++i)
                 continue;
             if (pixels.rgba.empty()) throw DeviceError("this device cannot read its window");
             write_png(arguments[0], {pixels.width, pixels.height, std::move(pixels.rgba)});
             // A script's next picture of the window shall not have the message.
             if (!options_.script) report("Wrote " + arguments[0], false);
         }},
        {"camera-line",
         [&] {
             need_scene();
             const CaptureSettings settings = full_settings(state_.edited_look);
             write_text_file(arguments[0],
                             capture_line(first_input(), settings, state_.scene->loaded.scene.background) + "\n");
         }},
        {"copy-camera",
         [&] {
             need_scene();
             const CaptureSettings settings = full_settings(state_.edited_look);
             window_.set_clipboard(capture_line(first_input(), settings, state_.scene->loaded.scene.background));
             report("The command line is on the clipboard", false);
         }},
        {"save-scene",
         [&] {
             need_scene();
             save_scene(arguments[0]);
         }},
        {"bookmark",
         [&] {
             need_scene();
             auto& bookmarks = state_.scene->loaded.description.bookmarks;
             std::erase_if(bookmarks, [&](const CameraBookmark& known) { return known.name == arguments[0]; });
             bookmarks.push_back({arguments[0], state_.camera.camera()});
         }},
        {"go",
         [&] {
             need_scene();
             go_to(arguments[0]);
         }},
        {"forget",
         [&] {
             need_scene();
             std::erase_if(state_.scene->loaded.description.bookmarks,
                           [&](const CameraBookmark& known) { return known.name == arguments[0]; });
         }},
        {"turntable",
         [&] {
             need_scene();
             turntable_ =
                 Turntable{arguments[1], state_.camera.camera(), static_cast<std::uint32_t>(command.number(0)), 0};
         }},
        {"statistics", [&] { write_statistics(arguments[0]); }},
        {"lose-surface", [&] { throw gpu::SurfaceLostError("as the script asked"); }},
        {"lose-device", [&] { throw gpu::DeviceLostError("as the script asked"); }},
        {"quit", [&] { quit_ = true; }},
    };
    commands.at(name)();
}

}  // namespace splice
