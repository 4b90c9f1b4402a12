#include "tests/simplify/patch_meshes.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>

namespace splice::test {

IndexedMesh mesh_of(std::vector<Vec3f> positions, std::vector<Triangle> triangles) {
    IndexedMesh mesh;
    mesh.positions = std::move(positions);
    mesh.triangles = std::move(triangles);
    std::vector<Vec3f> normals(mesh.positions.size(), Vec3f::Zero());
    for (const Triangle& t : mesh.triangles) {
        const Vec3f normal =
            (mesh.positions[t[1]] - mesh.positions[t[0]]).cross(mesh.positions[t[2]] - mesh.positions[t[0]]);
        for (const std::uint32_t v : t)
            normals[v] += normal;
    }
    for (const Triangle& t : mesh.triangles)
        for (const std::uint32_t v : t)
            mesh.corner_normals.push_back(normals[v].norm() > 0 ? Vec3f(normals[v].normalized())
                                                                : Vec3f(Vec3f::UnitZ()));
    mesh.materials.emplace_back();
    return mesh;
}

IndexedMesh height_field(unsigned cells, const std::function<float(float, float)>& height) {
    std::vector<Vec3f> positions;
    std::vector<Triangle> triangles;
    const auto at = [&](unsigned i) { return static_cast<float>(i) / static_cast<float>(cells) - 0.5f; };
    for (unsigned y = 0; y <= cells; ++y)
        for (unsigned x = 0; x <= cells; ++x)
            positions.emplace_back(at(x), at(y), height(at(x), at(y)));
    for (unsigned y = 0; y < cells; ++y) {
        for (unsigned x = 0; x < cells; ++x) {
            const unsigned corner = y * (cells + 1) + x;
            triangles.push_back({corner, corner + 1, corner + cells + 2});
            triangles.push_back({corner, corner + cells + 2, corner + cells + 1});
        }
    }
    return mesh_of(std::move(positions), std::move(triangles));
}

IndexedMesh bumpy_sphere(unsigned subdivisions, float bump) {
    std::vector<Vec3f> positions = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
    std::vector<Triangle> triangles = {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4},
                                       {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
    for (unsigned i = 0; i < subdivisions; ++i) {
        std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
        const auto middle = [&](std::uint32_t a, std::uint32_t b) {
            const auto [place, inserted] =
                middles.try_emplace(std::minmax(a, b), static_cast<std::uint32_t>(positions.size()));
            if (inserted) positions.emplace_back((positions[a] + positions[b]).normalized());
            return place->second;
        };
        std::vector<Triangle> finer;
        for (const auto& [a, b, c] : triangles) {
            const std::uint32_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
            finer.insert(finer.end(), {{a, ab, ca}, {b, bc, ab}, {c, ca, bc}, {ab, bc, ca}});
        }
        triangles = std::move(finer);
    }
    for (Vec3f& p : positions)
        p *= 0.4f + bump * std::sin(9 * p.x()) * std::sin(7 * p.y()) * std::sin(8 * p.z());
    return mesh_of(std::move(positions), std::move(triangles));
}

IndexedMesh fan(unsigned spokes) {
    std::vector<Vec3f> positions = {Vec3f(0, 0, 0.1f)};
    std::vector<Triangle> triangles;
    for (unsigned i = 0; i < spokes; ++i) {
        const double angle = 2 * M_PI * i / spokes;
        positions.emplace_back(static_cast<float>(0.5 * std::cos(angle)), static_cast<float>(0.5 * std::sin(angle)),
                               0.0f);
        triangles.push_back({0, 1 + i, 1 + (i + 1) % spokes});
    }
    return mesh_of(std::move(positions), std::move(triangles));
}

PatchSet divide(const IndexedMesh& mesh, const std::function<std::uint32_t(std::uint32_t)>& label) {
    PatchSet set;
    const auto triangles = static_cast<std::uint32_t>(mesh.triangles.size());
    std::uint32_t patches = 0;
    for (std::uint32_t t = 0; t < triangles; ++t) {
        set.triangle_patch.push_back(label(t));
        patches = std::max(patches, set.triangle_patch.back() + 1);
    }
    set.patches.resize(patches);
    set.patch_begin.push_back(0);
    for (std::uint32_t patch = 0; patch < patches; ++patch) {
        for (std::uint32_t t = 0; t < triangles; ++t)
            if (set.triangle_patch[t] == patch) set.patch_triangles.push_back(t);
        set.patch_begin.push_back(static_cast<std::uint32_t>(set.patch_triangles.size()));
    }
    return set;
}

Vec3f centroid(const IndexedMesh& mesh, std::uint32_t triangle) {
    const Triangle& t = mesh.triangles[triangle];
    return (mesh.positions[t[0]] + mesh.positions[t[1]] + mesh.positions[t[2]]) / 3;
}

}  // namespace splice::test
