#include "preprocess/cluster/face_graph.h"
#include "preprocess/cluster/roughness.h"
#include "preprocess/cluster/selection.h"
#include "preprocess/cluster/selection_auc.h"
#include "preprocess/mesh/shapes.h"
#include "tests/cluster/cluster_fixture.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <random>

using namespace splice;
using namespace splice::test;

namespace {

SourceMesh scaled(SourceMesh mesh, const Vec3d& by) {
    for (Vec3d& p : mesh.positions)
        p = p.cwiseProduct(by);
    return mesh;
}

}  // namespace

TEST_CASE("Flat faces are triangles up to their edges, however fine the mesh and thin the plate") {
    for (const std::uint32_t cells : {1u, 4u, 20u, 60u}) {
        CHECK(triangle_share(repaired(shapes::cube(cells)), cluster_mesh(repaired(shapes::cube(cells)), {})) == 1);
        const IndexedMesh plate = repaired(scaled(shapes::cube(cells), {1, 1, 0.004}));
        CHECK(triangle_share(plate, cluster_mesh(plate, {})) == 1);
        const IndexedMesh floor = repaired(shapes::checkerboard(4, cells));
        CHECK(triangle_share(floor, cluster_mesh(floor, {})) == 1);
    }
}

TEST_CASE("A plain sphere is triangles from a few to many of them") {
    for (const std::uint32_t frequency : {1u, 2u, 4u, 8u, 16u, 32u, 64u}) {
        const IndexedMesh mesh = repaired(shapes::ico_sphere(frequency));
        CHECK(triangle_share(mesh, cluster_mesh(mesh, {})) == 1);
    }
}

TEST_CASE("A dense bumpy sphere is surfels") {
    for (const std::uint64_t triangles : {30'000u, 60'000u, 200'000u}) {
        const IndexedMesh mesh = repaired(shapes::bumpy_sphere(triangles));
        const PatchSet set = cluster_mesh(mesh, {});
        CHECK(triangle_share(mesh, set) <= 0.1);
        CHECK(set.stats.selection_auc.value() >= 0.9);
    }
}

TEST_CASE("The choice does not depend on the model's size or place") {
    SourceMesh source = shapes::bumpy_sphere(20'000);
    const IndexedMesh mesh = repaired(source);
    for (Vec3d& p : source.positions)
        p = 1024 * p + Vec3d(4096, -8192, 512);
    const IndexedMesh moved = repaired(source);
    CHECK(triangle_share(moved, cluster_mesh(moved, {})) ==
          Approx(triangle_share(mesh, cluster_mesh(mesh, {}))).margin(0.01));
}

TEST_CASE("A machined part keeps its triangles") {
    const IndexedMesh mesh = repaired(shapes::machined_part(64));
    CHECK(triangle_share(mesh, cluster_mesh(mesh, {})) >= 0.9);
}

TEST_CASE("Roughness is zero on a plane, known on a sphere and on an edge") {
    const IndexedMesh plane = repaired(shapes::checkerboard(2, 100));
    const FaceRoughness flat = measure_roughness(plane, measure_faces(plane, order_faces(plane)));
    CHECK(*std::max_element(flat.ball.begin(), flat.ball.end()) < 1e-3f);

    // Within a ball of radius r on a sphere of radius R normals spread by r / (R sqrt 2): the RMS distance from the
    // centre of a disk is r / sqrt 2.
    const IndexedMesh sphere = repaired(shapes::ico_sphere(80));
    const FaceRoughness round = measure_roughness(sphere, measure_faces(sphere, order_faces(sphere)));
    const double mean =
        std::accumulate(round.ball.begin(), round.ball.end(), 0.0) / static_cast<double>(round.ball.size());
    CHECK(mean == Approx(0.02 / (0.5 * std::sqrt(2))).epsilon(0.1));

    const IndexedMesh cube = repaired(shapes::cube(100));
    const FaceGraph faces = measure_faces(cube, order_faces(cube));
    const FaceRoughness edges = measure_roughness(cube, faces);
    std::size_t on_edge = 0;
    for (std::size_t s = 0; s < faces.size(); ++s) {
        const auto [a, b, c] = faces.corners(cube, s);
        const Vec3f size = ((a + b + c) / 3.0f).cwiseAbs();
        // Beside an edge, away from corners.
        if (size.minCoeff() > 0.4f || (size.array() > 0.496f).count() != 2) continue;
        ++on_edge;
        // Half the ball's surface on either side: the mean of two orthogonal unit normals is sqrt(1/2) long.
        CHECK(static_cast<double>(edges.ball[s]) == Approx(std::sqrt(2 * (1 - std::sqrt(0.5)))).epsilon(0.15));
        CHECK(edges.sheet[s] < 1e-3f);
    }
    CHECK(on_edge > 100);
}

TEST_CASE("The number of triangles on a disk follows the size of the triangles") {
    for (const std::uint32_t cells : {20u, 50u, 100u}) {
        const IndexedMesh mesh = repaired(shapes::checkerboard(2, cells));
        const FaceRoughness roughness = measure_roughness(mesh, measure_faces(mesh, order_faces(mesh)));
        const double expected = std::numbers::pi * 0.02 * 0.02 * 2 * cells * cells;
        for (const float n : roughness.triangles)
            CHECK(static_cast<double>(n) == Approx(expected).epsilon(0.35));
    }
}

TEST_CASE("Narrow flat faces between sharp creases are triangles") {
    // A staircase of steps of a third of the ball's radius: nothing but planes and right angles.
    std::vector<Vec3d> positions;
    std::vector<Triangle> triangles;
    constexpr std::uint32_t kSteps = 100, kAlong = 40;
    for (std::uint32_t i = 0; i <= 2 * kSteps; ++i) {
        const double depth = ((i + 1) / 2) / double{kSteps}, height = (i / 2) / double{kSteps};
        for (std::uint32_t j = 0; j <= kAlong; ++j)
            positions.emplace_back(depth, height, j / double{kAlong});
    }
    const auto at = [&](std::uint32_t i, std::uint32_t j) { return i * (kAlong + 1) + j; };
    for (std::uint32_t i = 0; i < 2 * kSteps; ++i) {
        for (std::uint32_t j = 0; j < kAlong; ++j) {
            triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
            triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
        }
    }
    const IndexedMesh mesh = bare_mesh(positions, triangles);
    CHECK(triangle_share(mesh, cluster_mesh(mesh, {})) == 1);
}

TEST_CASE("Large triangles count as less rough than the same bend in small ones") {
    // Square cells whose corners are off the plane by up to a tenth of a cell, once 0.005 wide and once 0.05.
    const auto bumps = [](std::uint32_t cells) {
        std::mt19937 random(6);
        std::vector<Vec3d> positions;
        std::vector<Triangle> triangles;
        const double step = 1.0 / cells;
        for (std::uint32_t i = 0; i <= cells; ++i) {
            for (std::uint32_t j = 0; j <= cells; ++j) {
                const double height = 0.2 * step * (static_cast<double>(random()) / 4294967296.0 - 0.5);
                positions.emplace_back(i * step, j * step, height);
            }
        }
        const auto at = [&](std::uint32_t i, std::uint32_t j) { return i * (cells + 1) + j; };
        for (std::uint32_t i = 0; i < cells; ++i) {
            for (std::uint32_t j = 0; j < cells; ++j) {
                triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
                triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
            }
        }
        return bare_mesh(positions, triangles);
    };
    const IndexedMesh fine = bumps(200), coarse = bumps(20);
    CHECK(triangle_share(fine, cluster_mesh(fine, {})) < 0.05);
    CHECK(triangle_share(coarse, cluster_mesh(coarse, {})) > 0.95);
}

TEST_CASE("Patches are chosen from the flattest on, skipping what does not fit") {
    const std::vector<ScoredPatch> patches{{0.3f, 0, 10}, {0.1f, 1, 4}, {0.2f, 2, 7}, {0.2f, 3, 2}, {0.9f, 4, 1}};
    CHECK(choose_flattest(patches, 0).empty());
    CHECK(choose_flattest(patches, 4) == std::vector<std::uint32_t>{1});
    CHECK(choose_flattest(patches, 6) == std::vector<std::uint32_t>{1, 3});
    CHECK(choose_flattest(patches, 12) == std::vector<std::uint32_t>{1, 2, 4});
    CHECK(choose_flattest(patches, 24).size() == 5);
}

TEST_CASE("The AUC is 1 for a perfect choice, 0 for its opposite, one half by lot") {
    // Half a plane, half a zigzag.
    std::vector<Vec3d> positions;
    std::vector<Triangle> triangles;
    constexpr std::uint32_t kCells = 150;
    for (std::uint32_t i = 0; i <= kCells; ++i) {
        for (std::uint32_t j = 0; j <= kCells; ++j) {
            positions.emplace_back(i, j, i > kCells / 2 && i % 2 == 0 ? 0.4 : 0);
        }
    }
    const auto at = [&](std::uint32_t i, std::uint32_t j) { return i * (kCells + 1) + j; };
    for (std::uint32_t i = 0; i < kCells; ++i) {
        for (std::uint32_t j = 0; j < kCells; ++j) {
            triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
            triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
        }
    }
    const IndexedMesh mesh = bare_mesh(positions, triangles);
    const FaceGraph faces = measure_faces(mesh, order_faces(mesh));
    // Two patches, whatever their shape: the AUC only asks for the representation at a point.
    const auto auc = [&](const auto& is_surfel) {
        PatchSet set;
        set.patches.resize(2);
        set.patches[1].representation = format::Representation::kSurfels;
        for (std::uint32_t f = 0; f < mesh.triangles.size(); ++f)
            set.triangle_patch.push_back(is_surfel(f));
        return selection_auc(judge_places(mesh, faces), set).value();
    };
    const auto right = [&](std::uint32_t f) { return mesh.positions[mesh.triangles[f][0]].x() > 0; };
    CHECK(auc(right) > 0.98);
    CHECK(auc([&](std::uint32_t f) { return !right(f); }) < 0.02);
    CHECK(auc([&](std::uint32_t f) { return (f * 2654435761u >> 31) != 0; }) == Approx(0.5).margin(0.02));
    PatchSet one_kind;
    one_kind.patches.resize(1);
    one_kind.triangle_patch.resize(mesh.triangles.size(), 0);
    CHECK(!selection_auc(judge_places(mesh, faces), one_kind));
}
