// What commands do, whether a panel, a key or a script gives them.
#include "engine/viewer/free_name.h"
#include "engine/viewer/settings_file.h"
#include "engine/viewer/viewer.h"
#include "preprocess/model_format/atomic_file.h"
#include "preprocess/model_format/error.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <iostream>
#include <map>
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

constexpr Names<Selection, 2> kSelections{{{Selection::kGeometric, "geometric"}, {Selection::kThesis, "thesis"}}};

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
    if (command.merge_px)
        for (CaptureSettings& look : state_.looks)
            look.merge_px = *command.merge_px;
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

// Of an action: told with its place in the script, if a script asked for it.
void Viewer::fail(const std::string& text, std::size_t line) {
    if (text.empty()) return;
    if (!options_.script || line == 0) return report(text, true);
    script_failed_ = true;
    const std::string script = *options_.script == "-" ? "script" : options_.script->string();
    report(InputError(script, "line " + std::to_string(line), text).what(), true);
}

CaptureSettings Viewer::full_settings(std::size_t look) const {
    CaptureSettings settings = state_.looks[look];
    const Viewport viewport = area(look).size;
    settings.camera = state_.camera.camera();
    settings.width = viewport.width;
    settings.height = viewport.height;
    return settings;
}

void Viewer::open(std::vector<std::filesystem::path> paths, bool again, std::size_t line) {
    SceneRequest request{std::move(paths), {}, again, line};
    // One core stays with the window.
    request.options.threads = static_cast<int>(std::max(std::thread::hardware_concurrency(), 2U) - 1);
    if (again) request.options.bake = state_.bake;
    cancel_job();
    job_ = std::make_unique<SceneJob>(std::move(request));
}

void Viewer::go_to(const std::string& name) {
    for (const CameraBookmark& bookmark : state_.scene->loaded.description.bookmarks)
        if (bookmark.name == name) return state_.camera.set_camera(bookmark.camera);
    throw UsageError("no bookmark \"" + name + "\"");
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
        {"merge", [&] { look.merge_px = number(0, kMostMergePixels); }},
        {"budget", [&] { state_.moving_budget_ms = number(1, 1000); }},
        {"moving-tau", [&] { state_.moving_most_tau = number(0, MovingDetail::kCoarsest); }},
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
        {"selection",
         [&] {
             state_.bake.cluster.selection = named(kSelections, value, "set selection");
             state_.bake.cluster.triangle_share.reset();
         }},
        {"sampling",
         [&] {
             state_.bake.sampling.thesis_c.reset();
             if (value != "adaptive") state_.bake.sampling.thesis_c = number(0.1, 64);
         }},
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
    // Without a name, keys and buttons write a new file; scripts name theirs.
    const auto file_or_new = [&](const char* usual) -> std::filesystem::path {
        if (arguments.empty()) return free_name(usual);
        return arguments[0];
    };
    const std::map<std::string, std::function<void()>> commands{
        {"open",
         [&] {
             open({arguments.begin(), arguments.end()}, false, command.line);
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
        {"compare",
         [&] {
             state_.comparison = named(kComparisonNames, arguments[0], "compare");
             if (state_.comparison == Comparison::kOff) state_.edited_look = 0;
         }},
        {"panels", [&] { state_.panels = on_or_off("panels", arguments[0]); }},
        {"rebake",
         [&] {
             need_scene();
             if (!state_.scene->bakeable) throw UsageError("only meshes and shapes can be baked anew");
             open(state_.scene->paths, true, command.line);
         }},
        {"screenshot",
         [&] {
             need_scene();
             take_screenshot(file_or_new("splice-view.png"));
         }},
        {"screenshot-window", [&] { take_window_screenshot(file_or_new("splice-view-window.png")); }},
        {"camera-line",
         [&] {
             need_scene();
             write_text_file(arguments[0], camera_line() + "\n");
         }},
        {"copy-camera",
         [&] {
             need_scene();
             window_.set_clipboard(camera_line());
             report("The command line is on the clipboard", false);
         }},
        {"save-scene",
         [&] {
             need_scene();
             save_scene(file_or_new("splice-view.json"));
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
             const auto count = static_cast<std::uint32_t>(command.number(0));
             turntable_ =
                 Turntable{free_series("splice-view-turn.png", count), state_.camera.camera(), count, 0, command.line};
             if (arguments.size() > 1) turntable_->path = arguments[1];
         }},
        {"statistics", [&] { write_statistics(arguments[0]); }},
        {"lose-surface", [&] { throw gpu::SurfaceLostError("as the script asked"); }},
        {"lose-device", [&] { throw gpu::DeviceLostError("as the script asked"); }},
        {"quit", [&] { quit_ = true; }},
    };
    commands.at(name)();
}

}  // namespace splice
