#include "tests/cluster/cluster_fixture.h"

#include "tests/support/test_files.h"

#include <catch2/catch.hpp>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>
#include <random>

namespace splice::test {
namespace {

Vec3d cross_of(const IndexedMesh& mesh, std::uint32_t f) {
    const Triangle& t = mesh.triangles[f];
    const Vec3d a = mesh.positions[t[0]].cast<double>();
    return (mesh.positions[t[1]].cast<double>() - a).cross(mesh.positions[t[2]].cast<double>() - a);
}

/// Faces by edge, the edge's vertices ascending.
std::map<std::pair<std::uint32_t, std::uint32_t>, std::vector<std::uint32_t>> faces_by_edge(const IndexedMesh& mesh) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::vector<std::uint32_t>> edges;
    for (std::uint32_t f = 0; f < mesh.triangles.size(); ++f) {
        for (int k = 0; k < 3; ++k) {
            const std::uint32_t a = mesh.triangles[f][k], b = mesh.triangles[f][(k + 1) % 3];
            edges[{std::min(a, b), std::max(a, b)}].push_back(f);
        }
    }
    return edges;
}

std::uint32_t material_of(const IndexedMesh& mesh, std::uint32_t f) {
    return mesh.triangle_material.empty() ? 0 : mesh.triangle_material[f];
}

std::vector<std::uint32_t> patch_faces(const PatchSet& set, std::size_t p) {
    return {set.patch_triangles.begin() + set.patch_begin[p], set.patch_triangles.begin() + set.patch_begin[p + 1]};
}

void require_partition(const IndexedMesh& mesh, const PatchSet& set) {
    REQUIRE(set.patch_begin.size() == set.patches.size() + 1);
    REQUIRE(set.patch_begin.front() == 0);
    REQUIRE(set.patch_begin.back() == mesh.triangles.size());
    REQUIRE(set.patch_triangles.size() == mesh.triangles.size());
    REQUIRE(set.triangle_patch.size() == mesh.triangles.size());
    bool ascending = true, agreeing = true;
    std::vector<int> seen(mesh.triangles.size(), 0);
    for (std::uint32_t p = 0; p < set.patches.size(); ++p) {
        const auto faces = patch_faces(set, p);
        REQUIRE(!faces.empty());
        ascending &= std::is_sorted(faces.begin(), faces.end());
        for (const std::uint32_t f : faces) {
            REQUIRE(f < mesh.triangles.size());
            ++seen[f];
            agreeing &= set.triangle_patch[f] == p;
        }
    }
    REQUIRE(ascending);
    REQUIRE(agreeing);
    REQUIRE(std::all_of(seen.begin(), seen.end(), [](int n) { return n == 1; }));
}

void require_connected(const IndexedMesh& mesh, const PatchSet& set) {
    std::vector<std::uint32_t> parent(mesh.triangles.size());
    std::iota(parent.begin(), parent.end(), 0u);
    const auto root = [&](std::uint32_t f) {
        while (parent[f] != f)
            f = parent[f] = parent[parent[f]];
        return f;
    };
    for (const auto& [edge, faces] : faces_by_edge(mesh)) {
        if (faces.size() != 2 || set.triangle_patch[faces[0]] != set.triangle_patch[faces[1]]) continue;
        if (material_of(mesh, faces[0]) == material_of(mesh, faces[1])) parent[root(faces[0])] = root(faces[1]);
    }
    std::size_t pieces = 0;
    for (std::uint32_t f = 0; f < mesh.triangles.size(); ++f)
        pieces += root(f) == f;
    REQUIRE(pieces == set.patches.size());
}

void require_measures(const IndexedMesh& mesh, const PatchSet& set) {
    std::uint64_t triangle_patches = 0, kept = 0;
    for (std::size_t p = 0; p < set.patches.size(); ++p) {
        const ClusterPatch& patch = set.patches[p];
        const auto faces = patch_faces(set, p);
        double area = 0, turn = 0;
        Vec3d sum = Vec3d::Zero();
        for (const std::uint32_t f : faces) {
            REQUIRE(patch.material == material_of(mesh, f));
            area += cross_of(mesh, f).norm() / 2;
            sum += cross_of(mesh, f) / 2;
        }
        REQUIRE(static_cast<double>(patch.area) == Approx(area).epsilon(1e-4));
        REQUIRE(static_cast<double>(patch.mean_normal.norm()) == Approx(1).epsilon(1e-4));
        if (sum.norm() > 1e-3 * area) REQUIRE((patch.mean_normal.cast<double>() - sum.normalized()).norm() < 1e-3);
        for (const std::uint32_t f : faces) {
            const double chord = (cross_of(mesh, f).normalized() - patch.mean_normal.cast<double>()).norm();
            const double angle = 2 * std::asin(std::min(1.0, chord / 2));
            turn += cross_of(mesh, f).norm() / 2 * angle * angle;
        }
        REQUIRE(static_cast<double>(patch.roughness) == Approx(std::sqrt(turn / area)).margin(1e-3));
        if (patch.representation == format::Representation::kTriangles) ++triangle_patches, kept += faces.size();
    }
    REQUIRE(set.stats.triangle_patches == triangle_patches);
    REQUIRE(set.stats.surfel_patches == set.patches.size() - triangle_patches);
    REQUIRE(set.stats.triangles_in_triangle_patches == kept);
    const bool both_kinds = set.stats.triangle_patches > 0 && set.stats.surfel_patches > 0;
    if (!both_kinds) REQUIRE(!set.stats.selection_auc);
    if (set.stats.selection_auc) {
        REQUIRE(*set.stats.selection_auc >= 0);
        REQUIRE(*set.stats.selection_auc <= 1);
    }
}

void require_forest(const IndexedMesh& mesh, const PatchSet& set) {
    const std::size_t leaves = mesh.triangles.size();
    std::vector<int> parents(leaves + set.merge_tree.size(), 0);
    std::uint32_t phase = 1;
    for (std::size_t i = 0; i < set.merge_tree.size(); ++i) {
        const format::MergeNode& node = set.merge_tree[i];
        REQUIRE(std::isfinite(node.cost));
        REQUIRE((node.phase == phase || node.phase == phase + 1));
        phase = node.phase;
        for (const std::uint32_t child : node.child) {
            REQUIRE(child < leaves + i);
            ++parents[child];
        }
    }
    REQUIRE(phase <= 2);
    REQUIRE(std::all_of(parents.begin(), parents.end(), [](int n) { return n <= 1; }));
    REQUIRE(set.patches.size() == leaves - set.merge_tree.size());
    for (std::size_t p = 0; p < set.patches.size(); ++p) {
        REQUIRE(set.patches[p].merge_root < parents.size());
        REQUIRE(parents[set.patches[p].merge_root] == 0);
        std::vector<std::uint32_t> open{set.patches[p].merge_root}, reached;
        while (!open.empty()) {
            const std::uint32_t node = open.back();
            open.pop_back();
            if (node < leaves) {
                reached.push_back(node);
            } else {
                for (const std::uint32_t child : set.merge_tree[node - leaves].child)
                    open.push_back(child);
            }
        }
        std::sort(reached.begin(), reached.end());
        REQUIRE(reached == patch_faces(set, p));
    }
}

}  // namespace

IndexedMesh repaired(SourceMesh source) {
    RepairReport report;
    return repair_mesh(std::move(source), {}, report, "test mesh");
}

IndexedMesh bare_mesh(const std::vector<Vec3d>& positions, const std::vector<Triangle>& triangles) {
    Vec3d low = positions.front(), high = positions.front();
    for (const Vec3d& p : positions)
        low = low.cwiseMin(p), high = high.cwiseMax(p);
    IndexedMesh mesh;
    for (const Vec3d& p : positions) {
        mesh.positions.push_back(((p - (low + high) / 2) / (high - low).maxCoeff()).cast<float>());
    }
    mesh.triangles = triangles;
    mesh.materials.emplace_back();
    for (std::uint32_t f = 0; f < triangles.size(); ++f) {
        mesh.corner_normals.insert(mesh.corner_normals.end(), 3, cross_of(mesh, f).normalized().cast<float>());
    }
    return mesh;
}

std::optional<IndexedMesh> collection_mesh(const std::string& name) {
    const auto path = model_file("meshes/" + name);
    if (!path) return std::nullopt;
    return repaired(read_mesh_file(*path));
}

FaceGraph graph_of(const IndexedMesh& mesh) {
    FaceGraph faces = measure_faces(mesh, order_faces(mesh));
    faces.links = link_faces(mesh, faces.face_of_slot, find_face_adjacency(mesh, faces.face_of_slot));
    return faces;
}

IndexedMesh random_blob(std::uint32_t n, std::uint32_t seed) {
    std::mt19937 random(seed);
    const auto wobble = [&] { return 0.2 * (static_cast<double>(random()) / 4294967296.0 - 0.5); };
    std::vector<Vec3d> positions{{0, 0, 1}};
    const std::uint32_t around = 2 * n;
    for (std::uint32_t i = 1; i < n; ++i) {
        for (std::uint32_t j = 0; j < around; ++j) {
            const double theta = std::numbers::pi * (i + wobble()) / n, phi = std::numbers::pi * (j + wobble()) / n;
            const double r = 1 + wobble();
            positions.emplace_back(r * std::sin(theta) * std::cos(phi), r * std::sin(theta) * std::sin(phi),
                                   r * std::cos(theta));
        }
    }
    positions.emplace_back(0, 0, -1);
    const auto at = [&](std::uint32_t i, std::uint32_t j) { return 1 + (i - 1) * around + j % around; };
    const auto south = static_cast<std::uint32_t>(positions.size() - 1);
    std::vector<Triangle> triangles;
    for (std::uint32_t j = 0; j < around; ++j) {
        triangles.push_back({0, at(1, j), at(1, j + 1)});
        for (std::uint32_t i = 1; i + 1 < n; ++i) {
            triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
            triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
        }
        triangles.push_back({at(n - 1, j), south, at(n - 1, j + 1)});
    }
    return bare_mesh(positions, triangles);
}

void require_sound(const IndexedMesh& mesh, const PatchSet& set) {
    require_partition(mesh, set);
    require_connected(mesh, set);
    require_measures(mesh, set);
    require_forest(mesh, set);
}

double triangle_share(const IndexedMesh& mesh, const PatchSet& set) {
    return static_cast<double>(set.stats.triangles_in_triangle_patches) / static_cast<double>(mesh.triangles.size());
}

}  // namespace splice::test
