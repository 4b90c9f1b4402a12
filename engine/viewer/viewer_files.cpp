// Files that the viewer writes: pictures, scenes, the line for splice-capture, statistics.
#include "engine/capture/look_settings.h"
#include "engine/capture/png_file.h"
#include "engine/viewer/capture_line.h"
#include "engine/viewer/free_name.h"
#include "engine/viewer/process_memory.h"
#include "engine/viewer/viewer.h"
#include "preprocess/model_format/atomic_file.h"
#include "preprocess/model_format/error.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <numeric>
#include <utility>

namespace splice {

void Viewer::take_screenshot(const std::filesystem::path& path) {
    Frame frame = graphics_->renderer->render(state_.scene->loaded.scene, full_settings(state_.edited_look));
    write_png(path, {frame.width, frame.height, std::move(frame.rgba)});
    report("Wrote " + path.string(), false);
}

void Viewer::take_window_screenshot(const std::filesystem::path& path) {
    moved_at_ = -1e9;
    draw_pictures();
    WindowPixels pixels;
    // Twice where the window changed, or fonts were missing.
    for (int i = 0; i < 4 && !show_window(&pixels); ++i)
        continue;
    if (pixels.rgba.empty()) throw DeviceError("this device cannot read its window");
    write_png(path, {pixels.width, pixels.height, std::move(pixels.rgba)});
    // A script's next picture of the window shall not have the message.
    if (!options_.script) report("Wrote " + path.string(), false);
}

// What is open, as it is shown by one of the looks, without a comparison.
SceneDescription Viewer::describe(std::size_t look) const {
    const OpenScene& scene = *state_.scene;
    SceneDescription description = scene.loaded.description;
    for (SceneModel& model : description.models)
        if (auto* file = std::get_if<std::filesystem::path>(&model.source)) *file = std::filesystem::absolute(*file);
    const CaptureSettings settings = full_settings(look);
    description.camera = settings.camera;
    description.lighting = scene.loaded.scene.lighting;
    description.background = scene.loaded.scene.background;
    description.width = settings.width;
    description.height = settings.height;
    description.look = look_of(settings);
    description.levels_from = settings.cut_camera;
    description.comparison = {};
    return description;
}

void Viewer::save_scene(const std::filesystem::path& path) {
    SceneDescription description = describe(0);
    description.comparison = {state_.comparison, state_.wipe, look_of(state_.looks[1])};
    write_text_file(path, write_scene(description, std::filesystem::absolute(path).parent_path()));
    report("Wrote " + path.string(), false);
}

// Whether files and options of splice-capture do not say all that the picture depends on.
bool Viewer::line_needs_scene(const CaptureSettings& settings) const {
    const OpenScene& scene = *state_.scene;
    const SceneDescription& description = scene.loaded.description;
    const bool from_scene_file = scene.prepared.from_scene_file;
    const bool baked_otherwise =
        scene.baked_anew && (from_scene_file || std::ranges::any_of(description.models, [](const SceneModel& model) {
                                 return !model.bake_members.empty();
                             }));
    const bool other_sides = settings.sides == Sides::kAsBaked && description.look.sides != Sides::kAsBaked;
    return baked_otherwise || other_sides || settings.cut_camera || description.levels_from ||
           scene.loaded.scene.lighting != description.lighting;
}

// Names the files that are open, or a scene that is saved for it.
std::string Viewer::camera_line() {
    const CaptureSettings settings = full_settings(state_.edited_look);
    std::vector<std::filesystem::path> inputs = state_.scene->paths;
    if (line_needs_scene(settings)) {
        const std::filesystem::path path = free_name("splice-view.json");
        write_text_file(path, write_scene(describe(state_.edited_look), std::filesystem::absolute(path).parent_path()));
        report("Wrote " + path.string() + ", which the command line names", false);
        inputs = {path};
    }
    for (std::filesystem::path& input : inputs)
        input = std::filesystem::absolute(input);
    return capture_line(inputs, settings, state_.scene->loaded.scene.background);
}

void Viewer::write_statistics(const std::filesystem::path& path) {
    const CutStats& cut = measured_.stats.cut;
    nlohmann::ordered_json start;
    for (const auto& [step, seconds] : start_steps_)
        start[step] = seconds;
    nlohmann::ordered_json passes;
    for (const PassHistory::Series& pass : measured_.history.series())
        passes[pass.name] = std::accumulate(pass.ms.begin(), pass.ms.end(), 0.0) / PassHistory::kFrames;
    nlohmann::ordered_json picked;  // null: nothing
    if (const std::optional<Hit>& hit = state_.picked)
        picked = {{"instance", hit->instance},
                  {"patch", hit->patch},
                  {"kind", hit->kind == format::Representation::kSurfels ? "surfels" : "triangles"},
                  {"element", hit->element},
                  {"point", {hit->point.x, hit->point.y, hit->point.z}}};
    const ProcessMemory memory = process_memory();
    const PageStats& pages = measured_.stats.pages;
    const nlohmann::ordered_json json{
        {"first_picture_s", state_.first_picture_s},
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
        {"present_mode", gpu::kPresentModeNames[static_cast<std::size_t>(state_.present_mode)].name},
        {"picked", picked},
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

}  // namespace splice
