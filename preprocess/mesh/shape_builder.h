// What the procedural meshes share.
#pragma once

#include "preprocess/mesh/read_mesh.h"
#include "preprocess/mesh/source_mesh_builder.h"

#include <initializer_list>

namespace splice::shapes {

inline SourceMesh empty_mesh() {
    SourceMesh mesh;
    mesh.polygon_begin.push_back(0);
    return mesh;
}

inline std::uint32_t add_vertex(SourceMesh& mesh, const Vec3d& position) {
    mesh.positions.push_back(position);
    return static_cast<std::uint32_t>(mesh.positions.size() - 1);
}

inline void add_polygon(SourceMesh& mesh, std::initializer_list<std::uint32_t> corners) {
    mesh.corner_position.insert(mesh.corner_position.end(), corners);
    mesh.polygon_begin.push_back(mesh.corner_position.size());
}

}  // namespace splice::shapes
