// The cameras of a run of splice-capture: one, or an orbit.
#pragma once

#include "engine/capture/capture_command_line.h"
#include "engine/scene/camera.h"
#include "engine/scene/scene_file.h"

#include <cstddef>
#include <filesystem>
#include <vector>

namespace splice {

/// The command line's camera, else the scene's, else the one that frames `bounds`. An orbit turns it about the target's
/// up direction in equal steps; a framing camera keeps the distance that shows the whole of `bounds` from every side.
std::vector<Camera> camera_path(const CaptureCommand& command, const SceneDescription& scene, const Box& bounds);

/// OUT.png -> OUT-007.png, with as many digits as `count` frames need, at least three.
std::filesystem::path numbered(const std::filesystem::path& path, std::size_t index, std::size_t count);

}  // namespace splice
