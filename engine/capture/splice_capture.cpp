// splice-capture INPUT -o OUT.png: a picture of a model, a scene or a mesh.
#include "engine/capture/camera_path.h"
#include "engine/capture/capture_command_line.h"
#include "engine/capture/load_scene.h"
#include "engine/capture/png_file.h"
#include "engine/capture/stats_json.h"
#include "preprocess/build_model/program_main.h"
#include "preprocess/build_model/stage_display.h"
#include "preprocess/model_format/atomic_file.h"
#include "preprocess/model_format/error.h"

#include <iostream>

namespace {

using namespace splice;

LoadedScene load(const CaptureCommand& command, Renderer& renderer) {
    StageDisplay display(command.quiet);
    LoadedScene loaded = load_scene(command.input, renderer,
                                    [&](std::string_view stage, double fraction) { display.update(stage, fraction); });
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
    settings.view = command.view.value_or(scene.view);
    settings.backend = command.backend.value_or(settings.backend);
    settings.sides = command.sides.value_or(scene.sides);
    settings.epsilon_scale = command.epsilon_scale.value_or(scene.epsilon_scale);
    settings.prefilter = command.prefilter.value_or(scene.prefilter);
    settings.want_overlap = command.stats.has_value();
    return settings;
}

void check_validation(const Renderer& renderer) {
    const std::vector<std::string> messages = renderer.validation_messages();
    if (messages.empty()) return;
    throw DeviceError("the validation layers report " + std::to_string(messages.size()) +
                      " problem(s), the first: " + messages.front());
}

int capture(const CaptureCommand& command) {
    check_output_path(command.output);
    if (command.stats) check_output_path(*command.stats);
    Renderer renderer(command.renderer);
    const LoadedScene loaded = load(command, renderer);
    CaptureSettings settings = settings_of(command, loaded.description);

    std::vector<CapturedFile> files;
    const std::vector<Camera> cameras = camera_path(command, loaded.description, loaded.scene.bounds());
    for (std::size_t i = 0; i < cameras.size(); ++i) {
        settings.camera = cameras[i];
        Frame frame = renderer.render(loaded.scene, settings);
        // The first frame of a process compiles shaders, which says nothing about frames.
        if (command.stats && i == 0) frame = renderer.render(loaded.scene, settings);
        check_validation(renderer);
        const std::filesystem::path path =
            command.orbit > 0 ? numbered(command.output, i, cameras.size()) : command.output;
        write_png(path, {frame.width, frame.height, std::move(frame.rgba)});
        files.push_back({path.string(), std::move(frame.stats)});
    }
    if (command.stats) write_text_file(*command.stats, stats_json(files));
    if (command.quiet) return 0;
    const FrameStats& last = files.back().stats;
    std::cout << last.surfels_drawn << " surfels and " << last.triangles_drawn << " triangles on " << last.device
              << "\nwrote " << files.front().path;
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
