#include "tests/cluster/cluster_fixture.h"

#include <catch2/catch.hpp>

#include <numbers>

using namespace splice;
using namespace splice::test;

namespace {

void require_sound_in_all_modes(const IndexedMesh& mesh) {
    for (const Selection selection : {Selection::kGeometric, Selection::kThesis}) {
        for (const auto representation :
             {ForcedRepresentation::kHybrid, ForcedRepresentation::kTriangles, ForcedRepresentation::kSurfels}) {
            for (const double cost : {-10.0, 0.1, 1e9}) {
                for (const double area : {1e-6, 0.3, 1.0}) {
                    ClusterOptions options;
                    options.selection = selection;
                    options.representation = representation;
                    options.phase1_cost = cost;
                    options.phase2_cost = cost;
                    options.max_patch_area = area;
                    require_sound(mesh, cluster_mesh(mesh, options));
                }
            }
        }
    }
    require_sound(mesh, cluster_mesh(mesh, {}));
}

const std::vector<Vec3d> kTetrahedron{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
const std::vector<Triangle> kTetrahedronFaces{{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}};

}  // namespace

TEST_CASE("One triangle is one triangle patch") {
    const IndexedMesh mesh = bare_mesh({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}});
    require_sound_in_all_modes(mesh);
    const PatchSet set = cluster_mesh(mesh, {});
    REQUIRE(set.patches.size() == 1);
    CHECK(set.stats.triangle_patches == 1);
    CHECK(set.merge_tree.empty());
    CHECK(set.patches[0].merge_root == 0);
}

TEST_CASE("A closed surface may become one patch") {
    const IndexedMesh mesh = bare_mesh(kTetrahedron, kTetrahedronFaces);
    require_sound_in_all_modes(mesh);
    ClusterOptions options;
    options.selection = Selection::kThesis;
    options.phase1_cost = 1e9;
    options.max_patch_area = 1;
    CHECK(cluster_mesh(mesh, options).patches.size() == 1);
}

TEST_CASE("Two components are at least two patches") {
    std::vector<Vec3d> positions = kTetrahedron;
    std::vector<Triangle> triangles = kTetrahedronFaces;
    for (const Vec3d& p : kTetrahedron)
        positions.push_back(p + Vec3d(3, 0, 0));
    for (const Triangle& t : kTetrahedronFaces)
        triangles.push_back({t[0] + 4, t[1] + 4, t[2] + 4});
    const IndexedMesh mesh = bare_mesh(positions, triangles);
    require_sound_in_all_modes(mesh);
    ClusterOptions options;
    options.representation = ForcedRepresentation::kSurfels;
    options.phase2_cost = 1e9;
    options.max_patch_area = 1;
    CHECK(cluster_mesh(mesh, options).patches.size() == 2);
}

TEST_CASE("Unconnected triangles are patches of their own") {
    std::vector<Vec3d> positions;
    std::vector<Triangle> triangles;
    for (std::uint32_t i = 0; i < 100; ++i) {
        const Vec3d at(i % 10, static_cast<double>(i) / 10, 0.1 * (i % 7));
        positions.insert(positions.end(), {at, at + Vec3d(0.5, 0, 0.1), at + Vec3d(0, 0.5, 0.1 * (i % 3))});
        triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
    }
    const IndexedMesh mesh = bare_mesh(positions, triangles);
    require_sound_in_all_modes(mesh);
    CHECK(cluster_mesh(mesh, {}).patches.size() == 100);
}

TEST_CASE("Every face around a non-manifold edge is in a patch, on its own side of the edge") {
    std::vector<Vec3d> positions{{0, 0, 0}, {0, 0, 1}};
    std::vector<Triangle> triangles;
    for (std::uint32_t i = 0; i < 5; ++i) {
        const double angle = 2 * std::numbers::pi * i / 5;
        positions.emplace_back(std::cos(angle), std::sin(angle), 0);
        triangles.push_back(i % 2 == 0 ? Triangle{0, 1, 2 + i} : Triangle{1, 0, 2 + i});
    }
    const IndexedMesh mesh = bare_mesh(positions, triangles);
    require_sound_in_all_modes(mesh);
    CHECK(cluster_mesh(mesh, {}).patches.size() == 5);
}

TEST_CASE("A bowtie is two patches") {
    const IndexedMesh mesh =
        bare_mesh({{0, 0, 0}, {1, 0.5, 0}, {1, -0.5, 0}, {-1, 0.5, 0}, {-1, -0.5, 0}}, {{0, 2, 1}, {0, 3, 4}});
    require_sound_in_all_modes(mesh);
    CHECK(cluster_mesh(mesh, {}).patches.size() == 2);
}

TEST_CASE("A Moebius strip clusters across its seam") {
    constexpr std::uint32_t kSteps = 40;
    std::vector<Vec3d> positions;
    for (std::uint32_t i = 0; i < kSteps; ++i) {
        const double angle = 2 * std::numbers::pi * i / kSteps;
        const Vec3d out(std::cos(angle), std::sin(angle), 0);
        const Vec3d across = std::cos(angle / 2) * out + std::sin(angle / 2) * Vec3d::UnitZ();
        positions.push_back(out + 0.3 * across);
        positions.push_back(out - 0.3 * across);
    }
    std::vector<Triangle> triangles;
    for (std::uint32_t i = 0; i < kSteps; ++i) {
        const bool last = i + 1 == kSteps;
        const std::uint32_t a = 2 * i, b = a + 1, c = last ? 1 : a + 2, d = last ? 0 : a + 3;
        triangles.push_back({a, b, c});
        triangles.push_back({c, b, d});
    }
    const IndexedMesh mesh = bare_mesh(positions, triangles);
    require_sound_in_all_modes(mesh);
    ClusterOptions options;
    options.representation = ForcedRepresentation::kSurfels;
    options.phase2_cost = 1e9;
    options.max_patch_area = 1;
    CHECK(cluster_mesh(mesh, options).patches.size() == 1);
}

TEST_CASE("Needle triangles do not upset areas or normals") {
    std::vector<Vec3d> positions;
    std::vector<Triangle> triangles;
    for (std::uint32_t i = 0; i < 200; ++i) {
        positions.emplace_back(i * 0.005, 0, 0);
        positions.emplace_back(i * 0.005 + 1e-6, 1e-5 * (1 + i % 3), 0);
        if (i == 0) continue;
        const std::uint32_t a = 2 * i - 2;
        triangles.push_back({a, a + 2, a + 1});
        triangles.push_back({a + 1, a + 2, a + 3});
    }
    require_sound_in_all_modes(bare_mesh(positions, triangles));
}
