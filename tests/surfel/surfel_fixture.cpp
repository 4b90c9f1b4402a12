#include "tests/surfel/surfel_fixture.h"

#include <cmath>
#include <map>
#include <numbers>
#include <tuple>

namespace splice::test {
namespace {

// Faces that leave a common edge, or a common tip, at different angles.
IndexedMesh wedge(double degrees) {
    const double angle = degrees * std::numbers::pi / 180;
    return mesh_of({{0, 0, 0},
                    {0, 0, 1},
                    {1, 0, 0},
                    {1, 0, 1},
                    {std::cos(angle), std::sin(angle), 0},
                    {std::cos(angle), std::sin(angle), 1}},
                   {{0, 2, 1}, {2, 3, 1}, {0, 1, 4}, {4, 1, 5}});
}

IndexedMesh sliver_fan() {
    std::vector<Vec3d> positions = {{0, 0, 0}};
    std::vector<Triangle> triangles;
    for (std::uint32_t i = 0; i <= 60; ++i) {
        const double angle = 0.006 * i;
        positions.emplace_back(std::cos(angle), std::sin(angle), 0.01 * std::sin(7 * angle));
        if (i > 0) triangles.push_back({0, i, i + 1});
    }
    return mesh_of(positions, triangles);
}

IndexedMesh sizes_far_apart() {
    // A large quad whose one corner is cut into ever smaller triangles.
    std::vector<Vec3d> positions = {{0, 1, 0}};
    std::vector<Triangle> triangles;
    for (std::uint32_t i = 0; i < 14; ++i)
        positions.emplace_back(std::pow(0.5, i), 0, 0);
    for (std::uint32_t i = 1; i + 1 < positions.size(); ++i)
        triangles.push_back({0, i + 1, i});
    return mesh_of(positions, triangles);
}

IndexedMesh soup() {
    std::vector<Vec3d> positions;
    std::vector<Triangle> triangles;
    std::uint32_t state = 1;
    const auto next = [&] {
        state = state * 1664525u + 1013904223u;
        return static_cast<double>(state >> 8) / 16777216.0;
    };
    for (std::uint32_t i = 0; i < 8; ++i) {
        for (int k = 0; k < 3; ++k)
            positions.emplace_back(next(), next(), next());
        triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
    }
    return mesh_of(positions, triangles);
}

}  // namespace

IndexedMesh repaired(SourceMesh source) {
    RepairReport report;
    return repair_mesh(std::move(source), {}, report, "test");
}

IndexedMesh mesh_of(const std::vector<Vec3d>& positions, const std::vector<Triangle>& triangles) {
    SourceMesh source;
    source.positions = positions;
    source.polygon_begin = {0};
    for (const auto& t : triangles) {
        source.corner_position.insert(source.corner_position.end(), t.begin(), t.end());
        source.polygon_begin.push_back(source.corner_position.size());
    }
    return repaired(std::move(source));
}

std::vector<NamedMesh> awkward_meshes() {
    std::vector<NamedMesh> meshes;
    meshes.push_back({"sphere", repaired(shapes::ico_sphere(6))});
    meshes.push_back({"fine sphere", repaired(shapes::ico_sphere(16))});
    meshes.push_back({"bumpy sphere", repaired(shapes::bumpy_sphere(1500))});
    meshes.push_back({"poles", repaired(shapes::uv_sphere(64, 8))});
    meshes.push_back({"cube", repaired(shapes::cube())});
    meshes.push_back({"torus knot", repaired(shapes::torus_knot(2, 3, 60, 8))});
    meshes.push_back({"terrain", repaired(shapes::terrain(12))});
    meshes.push_back({"machined part", repaired(shapes::machined_part(12))});
    meshes.push_back({"single triangle", mesh_of({{0, 0, 0}, {1, 0, 0}, {0.3, 0.8, 0.2}}, {{0, 1, 2}})});
    meshes.push_back({"needle", mesh_of({{0, 0, 0}, {1, 0.0001, 0}, {1, -0.0001, 0.3}}, {{0, 1, 2}})});
    meshes.push_back({"thread", mesh_of({{0, 0, 0}, {1, 1e-5, 0}, {1, 0, 0}}, {{0, 1, 2}})});
    meshes.push_back({"sliver fan", sliver_fan()});
    meshes.push_back({"wedge of 20 degrees", wedge(20)});
    meshes.push_back({"wedge of 80 degrees", wedge(80)});
    meshes.push_back({"fold of 170 degrees", wedge(170)});
    meshes.push_back(
        {"three pages of a book", mesh_of({{0, 0, 0}, {0, 1, 0}, {1, 0.5, 0}, {-0.6, 0.5, 0.7}, {-0.5, 0.5, -0.8}},
                                          {{0, 2, 1}, {0, 3, 1}, {0, 4, 1}})});
    meshes.push_back({"sizes far apart", sizes_far_apart()});
    meshes.push_back({"soup", soup()});
    return meshes;
}

PatchSet one_patch(const IndexedMesh& mesh) {
    return patches_by_cell(mesh, 1);
}

PatchSet patches_by_cell(const IndexedMesh& mesh, int cells, bool every_other) {
    std::map<std::tuple<int, int, int>, std::vector<std::uint32_t>> groups;
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
        const auto& v = mesh.triangles[t];
        const Vec3f centroid = (mesh.positions[v[0]] + mesh.positions[v[1]] + mesh.positions[v[2]]) / 3;
        const auto cell = [&](int axis) {
            return static_cast<int>(std::floor((centroid[axis] + 0.5f) * 0.999f * static_cast<float>(cells)));
        };
        groups[{cell(0), cell(1), cell(2)}].push_back(t);
    }
    PatchSet set;
    set.triangle_patch.resize(mesh.triangles.size());
    set.patch_begin.push_back(0);
    for (const auto& [cell, triangles] : groups) {
        ClusterPatch patch;
        if (!every_other || set.patches.size() % 2 == 0) patch.representation = format::Representation::kSurfels;
        for (const auto t : triangles)
            set.triangle_patch[t] = static_cast<std::uint32_t>(set.patches.size());
        set.patches.push_back(patch);
        set.patch_triangles.insert(set.patch_triangles.end(), triangles.begin(), triangles.end());
        set.patch_begin.push_back(static_cast<std::uint32_t>(set.patch_triangles.size()));
    }
    return set;
}

}  // namespace splice::test
