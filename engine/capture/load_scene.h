// From files to a scene on a device: scene files, model files, and meshes and procedural shapes baked on the way.
#pragma once

#include "engine/capture/capture.h"
#include "engine/scene/scene_file.h"
#include "preprocess/mesh/read_mesh.h"
#include "preprocess/progress.h"

#include <filesystem>
#include <string>
#include <vector>

namespace splice {

struct LoadedScene {
    SceneDescription description;  // of a model or mesh: default lights, default framing
    Scene scene;
    std::vector<std::string> warnings;
};

/// By content first (model files, JSON), else as a mesh, which is baked in memory with the default options. Models that
/// a scene names twice are loaded once. Throws InputError, SystemError, DeviceError.
LoadedScene load_scene(const std::filesystem::path& path, Renderer& renderer, const Progress& progress = {});

/// The files that load_scene reads: `path`, and the models and meshes that it names if it is a scene. Throws the same.
std::vector<std::filesystem::path> files_of_scene(const std::filesystem::path& path);

/// The mesh of a shape; kinds and parameters as in docs/scene_format.md. Throws InputError("NAME: PATH: ...").
SourceMesh make_shape(const ShapeDescription& shape, const std::string& name, const std::string& path);

}  // namespace splice
