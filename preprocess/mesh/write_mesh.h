// Meshes to files, for generated scenes and tests.
#pragma once

#include "preprocess/mesh/read_mesh.h"

#include <filesystem>

namespace splice {

/// OBJ with uvs, normals and colours as far as the mesh has them; materials go to FILE.mtl and images to FILE_N.ppm in
/// the same folder, FILE being `path` without its ending. Throws SystemError.
void write_obj(const SourceMesh& mesh, const std::filesystem::path& path);

/// Binary little-endian PLY. Corners that differ in normal or colour become vertices of their own; uvs, materials and
/// images are left out. Throws SystemError, and Error if a polygon has more than 255 corners.
void write_ply(const SourceMesh& mesh, const std::filesystem::path& path);

}  // namespace splice
