// Statements about meshes that several tests make.
#pragma once

#include "preprocess/mesh/mesh_formats.h"
#include "preprocess/model_format/error.h"
#include "tests/support/input_error.h"

#include <catch2/catch.hpp>

#include <Eigen/Geometry>
#include <string>
#include <vector>

namespace splice::test {

inline std::size_t polygons(const SourceMesh& mesh) {
    return mesh.polygon_begin.size() - 1;
}

inline std::vector<std::uint32_t> polygon(const SourceMesh& mesh, std::size_t p) {
    const auto at = [&](std::uint64_t i) { return mesh.corner_position.begin() + static_cast<std::ptrdiff_t>(i); };
    return {at(mesh.polygon_begin[p]), at(mesh.polygon_begin[p + 1])};
}

using Indices = std::vector<std::uint32_t>;

inline IndexedMesh repaired(SourceMesh source, RepairReport* report = nullptr) {
    RepairReport local;
    return repair_mesh(std::move(source), {}, report ? *report : local, "test");
}

inline double signed_volume(const IndexedMesh& mesh) {
    double six_volumes = 0;
    for (const Triangle& t : mesh.triangles) {
        const Vec3d a = mesh.positions[t[0]].cast<double>(), b = mesh.positions[t[1]].cast<double>();
        six_volumes += a.dot(b.cross(mesh.positions[t[2]].cast<double>()));
    }
    return six_volumes / 6;
}

inline double area(const IndexedMesh& mesh) {
    double twice = 0;
    for (const Triangle& t : mesh.triangles) {
        const Vec3d a = mesh.positions[t[0]].cast<double>();
        twice += (mesh.positions[t[1]].cast<double>() - a).cross(mesh.positions[t[2]].cast<double>() - a).norm();
    }
    return twice / 2;
}

/// What indexed_mesh.h promises of a repaired mesh.
inline void check_invariants(const IndexedMesh& mesh) {
    const std::size_t corners = 3 * mesh.triangles.size();
    std::vector<bool> used(mesh.positions.size(), false);
    bool indices_valid = true, triangles_have_area = true;
    for (const Triangle& t : mesh.triangles) {
        for (const std::uint32_t v : t) {
            indices_valid = indices_valid && v < mesh.positions.size();
            if (v < used.size()) used[v] = true;
        }
        if (!indices_valid) break;
        const Vec3d a = mesh.positions[t[0]].cast<double>();
        const Vec3d normal = (mesh.positions[t[1]].cast<double>() - a).cross(mesh.positions[t[2]].cast<double>() - a);
        triangles_have_area = triangles_have_area && normal.squaredNorm() > 0;
    }
    CHECK(indices_valid);
    CHECK(triangles_have_area);
    CHECK(std::find(used.begin(), used.end(), false) == used.end());
    bool inside = true;
    Vec3f low = Vec3f::Constant(1), high = Vec3f::Constant(-1);
    for (const Vec3f& p : mesh.positions) {
        inside = inside && p.cwiseAbs().maxCoeff() <= 0.5f;
        low = low.cwiseMin(p);
        high = high.cwiseMax(p);
    }
    CHECK(inside);
    CHECK((high - low).maxCoeff() == Approx(1).epsilon(1e-6));
    REQUIRE(mesh.corner_normals.size() == corners);
    bool unit = true;
    for (const Vec3f& n : mesh.corner_normals)
        unit = unit && std::abs(n.norm() - 1) < 1e-4f;
    CHECK(unit);
    CHECK((mesh.corner_uvs.empty() || mesh.corner_uvs.size() == corners));
    CHECK((mesh.corner_colours.empty() || mesh.corner_colours.size() == corners));
    CHECK((mesh.triangle_material.empty() || mesh.triangle_material.size() == mesh.triangles.size()));
    REQUIRE(!mesh.materials.empty());
    for (const std::uint32_t material : mesh.triangle_material)
        REQUIRE(material < mesh.materials.size());
    for (const MeshMaterial& material : mesh.materials) {
        CHECK((material.image == kNoImage || material.image < mesh.images.size()));
    }
}

}  // namespace splice::test
