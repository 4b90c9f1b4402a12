// Puts a frame of the renderer and the oracle's view of the same mesh side by side.
#pragma once

#include "engine/capture/capture.h"
#include "preprocess/mesh/indexed_mesh.h"
#include "tests/reference/metrics.h"
#include "tests/reference/reference_scene.h"

#include <filesystem>

namespace splice::reference {

/// Reads and repairs: the mesh that the bake sees. Throws InputError, SystemError.
IndexedMesh load_mesh(const std::filesystem::path& path);

/// The engine's camera, as the oracle takes it: the mesh in unit-box units -> source units -> eye.
ReferenceView reference_view(const IndexedMesh& mesh, const Camera& camera, std::uint32_t width, std::uint32_t height);

/// The camera that frames `bounds` as splice-capture does, from `direction` (model to eye, unit).
Camera camera_from(const Box& bounds, const glm::dvec3& direction, std::uint32_t width, std::uint32_t height,
                   bool orthographic = false);

/// Linear light of the scene's background.
glm::vec3 background_light(const Background& background);

ColourImage colours(const Frame& frame);

/// Distances along the view direction in world units; kNothing where the frame covers nothing. Needs want_depth.
DepthImage depths(const Frame& frame);

}  // namespace splice::reference
