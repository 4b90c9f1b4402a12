// What the mesh targets have in common: whatever the bytes, the parser and the repair after it either deliver what
// indexed_mesh.h promises or throw a splice::Error.
#pragma once

#include "preprocess/mesh/mesh_formats.h"
#include "preprocess/model_format/error.h"
#include "tests/fuzz/fuzz_check.h"

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace splice::fuzz {

inline void check_source(const SourceMesh& mesh) {
    const std::size_t corners = mesh.corner_position.size();
    require(!mesh.polygon_begin.empty() && mesh.polygon_begin.front() == 0 && mesh.polygon_begin.back() == corners,
            "polygons cover the corners");
    for (std::size_t p = 1; p < mesh.polygon_begin.size(); ++p) {
        require(mesh.polygon_begin[p - 1] <= mesh.polygon_begin[p], "polygons follow each other");
    }
    const auto fits = [](std::size_t count, std::size_t expected) { return count == 0 || count == expected; };
    require(fits(mesh.corner_normals.size(), corners) && fits(mesh.corner_uvs.size(), corners) &&
                fits(mesh.corner_colours.size(), corners) &&
                fits(mesh.polygon_material.size(), mesh.polygon_begin.size() - 1),
            "attributes are absent or complete");
}

inline void check_repaired(const IndexedMesh& mesh) {
    const std::size_t corners = 3 * mesh.triangles.size();
    require(corners > 0 && mesh.corner_normals.size() == corners, "triangles with normals");
    for (const Triangle& t : mesh.triangles) {
        require(t[0] != t[1] && t[1] != t[2] && t[2] != t[0], "no repeated vertex");
        for (const std::uint32_t v : t)
            require(v < mesh.positions.size(), "indices in range");
    }
    for (const Vec3f& p : mesh.positions)
        require(p.cwiseAbs().maxCoeff() <= 0.5f, "positions inside the unit box");
    for (const Vec3f& n : mesh.corner_normals)
        require(std::abs(n.norm() - 1) < 1e-3f, "unit normals");
    for (const std::uint32_t material : mesh.triangle_material) {
        require(material < mesh.materials.size(), "materials in range");
    }
}

/// `parse` makes a SourceMesh from a std::string_view.
template <class Parse>
int run(const std::uint8_t* data, std::size_t size, Parse parse) {
    try {
        SourceMesh source = parse(std::string_view(reinterpret_cast<const char*>(data), size));
        check_source(source);
        RepairReport report;
        check_repaired(repair_mesh(std::move(source), {}, report, "input"));
    } catch (const Error&) {
        return 0;
    }
    return 0;
}

}  // namespace splice::fuzz
