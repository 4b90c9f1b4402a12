// From files to a scene on a device.
#pragma once

#include "engine/capture/capture.h"
#include "engine/capture/prepare_scene.h"

#include <filesystem>
#include <string>
#include <vector>

namespace splice {

struct LoadedScene {
    SceneDescription description;
    Scene scene;
    std::vector<std::string> warnings;
    std::vector<std::filesystem::path> companions;  // of PreparedScene
};

/// Models that a scene names twice are loaded once. Of surfels no more than `memory` bytes are held, shared among the
/// models by their sizes. Throws DeviceError.
LoadedScene upload_scene(const PreparedScene& prepared, Renderer& renderer, std::optional<std::uint64_t> memory = {});

/// The two steps in one; meshes are baked with the default options. Throws InputError, SystemError, DeviceError.
LoadedScene load_scene(const std::filesystem::path& path, Renderer& renderer, const Progress& progress = {},
                       std::optional<std::uint64_t> memory = {});

}  // namespace splice
