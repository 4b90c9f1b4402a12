// splice-capture INPUT -o OUT.png: a picture of a model, a scene or a mesh.
#include "engine/capture/calibrate.h"
#include "engine/capture/camera_path.h"
#include "engine/capture/capture_command_line.h"
#include "engine/capture/load_scene.h"
#include "engine/capture/look_settings.h"
#include "engine/capture/png_file.h"
#include "engine/capture/stats_json.h"
#include "preprocess/build_model/counted.h"
#include "preprocess/build_model/distinct_files.h"
#include "preprocess/build_model/program_main.h"
#include "preprocess/build_model/stage_display.h"
#include "preprocess/model_format/atomic_file.h"
#include "preprocess/model_format/error.h"

#include <algorithm>
#include <iostream>

namespace {

using namespace splice;

LoadedScene load(const CaptureCommand& command, Renderer& renderer) {
    StageDisplay display(command.quiet);
    const PreparedScene prepared = prepare_scene(
        command.inputs, {}, [&](std::string_view stage, double fraction) { display.update(stage, fraction); });
    LoadedScene loaded = upload_scene(prepared, renderer, command.memory);
    display.finish();
    if (!command.quiet)
        for (const std::string& warning : loaded.warnings)
            std::cerr << "splice-capture: warning: " << warning << '\n';
    if (command.background) loaded.scene.background = *command.background;
    return loaded;
}

CaptureSettings settings_of(const CaptureCommand& command, const SceneDescription& scene) {
    CaptureSettings settings;
    settings.width = command.size ? command.size->first : scene.width;
    settings.height = command.size ? command.size->second : scene.height;
    apply_look(scene.look, settings);
    settings.view = command.view.value_or(settings.view);
    settings.shown = command.shown.value_or(settings.shown);
    settings.backend = command.backend.value_or(settings.backend);
    settings.points_below = command.points_below;
    settings.merge_px = command.merge_px.value_or(settings.merge_px);
    settings.sides = command.sides.value_or(settings.sides);
    settings.epsilon_scale = command.epsilon_scale.value_or(settings.epsilon_scale);
    settings.prefilter = command.prefilter.value_or(settings.prefilter);
    settings.shading = command.shading.value_or(settings.shading);
    settings.antialias = command.antialias.value_or(settings.antialias);
    settings.kernel = command.kernel.value_or(settings.kernel);
    settings.tau = command.tau.value_or(settings.tau);
    settings.cut_camera = scene.levels_from;
    settings.budget_ms = command.budget_ms;
    settings.want_overlap = command.stats.has_value();
    if (command.graph) settings.want_graph = graph::export_format_of(command.graph->string());
    return settings;
}

void check_validation(const Renderer& renderer) {
    const std::vector<std::string> messages = renderer.validation_messages();
    if (messages.empty()) return;
    throw DeviceError("the validation layers report " + std::to_string(messages.size()) +
                      " problem(s), the first: " + messages.front());
}

std::filesystem::path picture_path(const CaptureCommand& command, std::size_t index) {
    return command.orbit > 0 ? numbered(command.output, index, command.orbit) : command.output;
}

// `companions`: materials and textures that meshes name, known once they are read.
void check_files(const CaptureCommand& command, const std::vector<std::filesystem::path>& companions = {}) {
    std::vector<NamedFile> inputs, outputs;
    for (const std::filesystem::path& input : command.inputs) {
        const std::vector<std::filesystem::path> files = files_of_scene(input);
        for (std::size_t i = 0; i < files.size(); ++i)
            inputs.push_back({i == 0 ? "INPUT" : "the scene's model", files[i]});
    }
    for (const std::filesystem::path& companion : companions)
        inputs.push_back({"a mesh's material or texture", companion});
    for (std::size_t i = 0; i < std::max(command.orbit, 1U); ++i)
        outputs.push_back({"--output", picture_path(command, i)});
    if (command.stats) outputs.push_back({"--stats", *command.stats});
    if (command.graph) outputs.push_back({"--graph", *command.graph});
    check_distinct_files(inputs, outputs);
}

int capture(const CaptureCommand& command) {
    check_files(command);
    check_output_path(command.output);
    if (command.stats) check_output_path(*command.stats);
    if (command.graph) check_output_path(*command.graph);
    Renderer renderer(command.renderer);
    const LoadedScene loaded = load(command, renderer);
    check_files(command, loaded.companions);
    CaptureSettings settings = settings_of(command, loaded.description);
    if (command.calibrate) settings.costs = calibrate(renderer, settings.backend).costs;

    std::vector<CapturedFile> files;
    const std::vector<Camera> cameras = camera_path(command, loaded.description, loaded.scene.bounds());
    for (std::size_t i = 0; i < cameras.size(); ++i) {
        settings.camera = cameras[i];
        Frame frame = renderer.render(loaded.scene, settings);
        // The first frame of a process compiles shaders, which says nothing about frames.
        if (command.stats && i == 0) frame = renderer.render(loaded.scene, settings);
        check_validation(renderer);
        if (command.graph && i == 0) write_text_file(*command.graph, frame.graph);
        const std::filesystem::path path = picture_path(command, i);
        write_png(path, {frame.width, frame.height, std::move(frame.rgba)});
        files.push_back({path.string(), std::move(frame.stats)});
    }
    if (command.stats) write_text_file(*command.stats, stats_json(files));
    if (command.quiet) return 0;
    const FrameStats& last = files.back().stats;
    std::cout << counted(last.surfels_drawn, "surfel") << " and " << counted(last.triangles_drawn, "triangle") << " on "
              << last.device << "\nwrote " << files.front().path;
    if (files.size() > 1) std::cout << " ... " << files.back().path;
    std::cout << std::endl;
    return 0;
}

}  // namespace

int main(int argc, char** argv) {
    return run_program("splice-capture", [&] {
        const auto command = parse_capture_command(argc, argv);
        if (!command) return 0;
        if (!command->list_devices) return capture(*command);
        for (const std::string& line : list_devices())
            std::cout << line << '\n';
        return 0;
    });
}
