// The meshes of a scene as one mesh in world units, for the oracle.
#pragma once

#include "engine/capture/load_scene.h"
#include "preprocess/mesh/indexed_mesh.h"

#include <filesystem>

namespace splice::bench {

/// What `loaded` was baked from, repaired as the bake repairs it, each instance in its place. Throws InputError where a
/// scene names a baked model, which does not tell its mesh; SystemError.
IndexedMesh world_mesh(const LoadedScene& loaded, const std::filesystem::path& path);

/// The repaired mesh with its source units for unit-box units.
IndexedMesh in_source_units(IndexedMesh mesh);

}  // namespace splice::bench
