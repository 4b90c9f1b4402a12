#include "preprocess/cluster/face_graph.h"
#include "preprocess/cluster/radix_sort.h"
#include "preprocess/mesh/shapes.h"
#include "tests/cluster/cluster_fixture.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <map>
#include <numbers>
#include <random>
#include <set>

using namespace splice;
using namespace splice::test;

namespace {

using Pairs = std::vector<std::pair<std::uint32_t, std::uint32_t>>;

Pairs pairs_of(const FaceAdjacency& adjacency) {
    Pairs pairs;
    for (const FacePair& p : adjacency.pairs)
        pairs.emplace_back(p.face[0], p.face[1]);
    std::sort(pairs.begin(), pairs.end());
    return pairs;
}

/// By counting edges, without a half-edge structure.
Pairs pairs_by_edges(const IndexedMesh& mesh) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::vector<std::uint32_t>> edges;
    for (std::uint32_t f = 0; f < mesh.triangles.size(); ++f) {
        for (int k = 0; k < 3; ++k) {
            const std::uint32_t a = mesh.triangles[f][k], b = mesh.triangles[f][(k + 1) % 3];
            edges[{std::min(a, b), std::max(a, b)}].push_back(f);
        }
    }
    Pairs pairs;
    for (const auto& [edge, faces] : edges) {
        if (faces.size() == 2) pairs.emplace_back(faces[0], faces[1]);
    }
    std::sort(pairs.begin(), pairs.end());
    return pairs;
}

const std::vector<Vec3d> kFivePoints{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {-1, -1, 0.3}};

}  // namespace

TEST_CASE("Each edge with two faces pairs them") {
    for (const IndexedMesh& mesh : {random_blob(10, 1), repaired(shapes::torus_knot(2, 3, 60, 6)),
                                    repaired(shapes::terrain(9)), repaired(shapes::machined_part(8))}) {
        const FaceAdjacency adjacency = find_face_adjacency(mesh, order_faces(mesh));
        CHECK(pairs_of(adjacency) == pairs_by_edges(mesh));
        CHECK(adjacency.torn_edges == 0);
    }
}

TEST_CASE("Faces around a non-manifold edge are kept and the edge is a border") {
    // Three and four faces around the edge 0-1, in turn.
    const std::vector<Triangle> fan{{0, 1, 2}, {1, 0, 3}, {0, 1, 4}};
    const IndexedMesh three = bare_mesh(kFivePoints, fan);
    const FaceAdjacency adjacency = find_face_adjacency(three, order_faces(three));
    CHECK(adjacency.pairs.empty());
    CHECK(adjacency.torn_edges == 1);
    CHECK(order_faces(three).size() == 3);

    std::vector<Vec3d> six = kFivePoints;
    six.emplace_back(0.4, -1, 0.7);
    const IndexedMesh four = bare_mesh(six, {{0, 1, 2}, {1, 0, 3}, {0, 1, 4}, {1, 0, 5}, {1, 2, 3}});
    CHECK(pairs_of(find_face_adjacency(four, order_faces(four))) == pairs_by_edges(four));
}

TEST_CASE("Faces of opposite orientation are paired all the same") {
    const IndexedMesh flipped = bare_mesh(kFivePoints, {{0, 1, 2}, {0, 1, 3}});
    CHECK(pairs_of(find_face_adjacency(flipped, order_faces(flipped))) == Pairs{{0, 1}});
}

TEST_CASE("A Moebius strip has no seam") {
    constexpr std::uint32_t kSteps = 24;
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
    const IndexedMesh strip = bare_mesh(positions, triangles);
    const Pairs pairs = pairs_of(find_face_adjacency(strip, order_faces(strip)));
    CHECK(pairs == pairs_by_edges(strip));
    CHECK(pairs.size() == triangles.size());
}

TEST_CASE("Any tangle of triangles is paired by its edges") {
    std::mt19937 random(5);
    for (const std::uint32_t vertices : {5u, 8u, 20u, 60u}) {
        for (int round = 0; round < 20; ++round) {
            std::vector<Vec3d> positions;
            for (std::uint32_t v = 0; v < vertices; ++v)
                positions.emplace_back(std::cos(v * 1.7), std::sin(v * 2.3), std::cos(v * v * 0.7));
            std::set<std::set<std::uint32_t>> seen;
            std::vector<Triangle> triangles;
            for (std::uint32_t i = 0; i < 2 * vertices; ++i) {
                const auto any = [&] { return static_cast<std::uint32_t>(random() % vertices); };
                const Triangle t{any(), any(), any()};
                const std::set<std::uint32_t> corners(t.begin(), t.end());
                if (corners.size() == 3 && seen.insert(corners).second) triangles.push_back(t);
            }
            const IndexedMesh tangle = bare_mesh(positions, triangles);
            REQUIRE(pairs_of(find_face_adjacency(tangle, order_faces(tangle))) == pairs_by_edges(tangle));
        }
    }
}

TEST_CASE("Two fans that share a vertex stay apart") {
    const IndexedMesh bowtie =
        bare_mesh({{0, 0, 0}, {1, 0.5, 0}, {1, -0.5, 0}, {-1, 0.5, 0}, {-1, -0.5, 0}}, {{0, 2, 1}, {0, 3, 4}});
    CHECK(find_face_adjacency(bowtie, order_faces(bowtie)).pairs.empty());
}

TEST_CASE("Links never cross materials") {
    IndexedMesh mesh = repaired(shapes::cube(4));
    const std::size_t all = link_faces(mesh, order_faces(mesh), find_face_adjacency(mesh, order_faces(mesh))).size();
    mesh.materials.resize(2);
    mesh.triangle_material.assign(mesh.triangles.size(), 0);
    for (std::size_t f = 0; f < mesh.triangles.size(); f += 2)
        mesh.triangle_material[f] = 1;
    const FaceGraph faces = measure_faces(mesh, order_faces(mesh));
    const auto links = link_faces(mesh, faces.face_of_slot, find_face_adjacency(mesh, order_faces(mesh)));
    CHECK(links.size() < all);
    for (const FaceGraph::Link& l : links) {
        CHECK(mesh.triangle_material[faces.face_of_slot[l.slot[0]]] ==
              mesh.triangle_material[faces.face_of_slot[l.slot[1]]]);
    }
}

TEST_CASE("Slots are a permutation of the faces with their measures") {
    const IndexedMesh mesh = random_blob(8, 2);
    const FaceGraph faces = measure_faces(mesh, order_faces(mesh));
    std::vector<std::uint32_t> sorted = faces.face_of_slot;
    std::sort(sorted.begin(), sorted.end());
    for (std::uint32_t f = 0; f < sorted.size(); ++f)
        REQUIRE(sorted[f] == f);
    for (std::size_t s = 0; s < faces.size(); ++s) {
        const auto [a, b, c] = faces.corners(mesh, s);
        CHECK(faces.perimeter[s] == Approx((b - a).norm() + (c - b).norm() + (a - c).norm()));
        // Heron's formula, which uses no cross product.
        const double x = static_cast<double>((b - a).norm()), y = static_cast<double>((c - b).norm()),
                     z = static_cast<double>((a - c).norm()), h = (x + y + z) / 2;
        CHECK(static_cast<double>(faces.area[s]) == Approx(std::sqrt(h * (h - x) * (h - y) * (h - z))).epsilon(1e-3));
        CHECK(faces.normal[s].dot(b - a) == Approx(0).margin(1e-5));
    }
}

TEST_CASE("A radix sort orders by the high half and keeps equal ones in their order") {
    std::mt19937_64 random(3);
    for (const std::uint64_t high_mask : {0xffffffffull, 0xf00000ffull, 0x7ull, 0x0ull}) {
        std::vector<std::uint64_t> entries(5000);
        for (std::uint64_t& entry : entries)
            entry = ((random() & high_mask) << 32) | (random() & 0xffffu);
        std::vector<std::uint64_t> expected = entries;
        std::stable_sort(expected.begin(), expected.end(),
                         [](std::uint64_t a, std::uint64_t b) { return a >> 32 < b >> 32; });
        radix_sort_by_high_half(entries);
        REQUIRE(entries == expected);
    }
    std::vector<std::uint64_t> none;
    radix_sort_by_high_half(none);
    REQUIRE(none.empty());
}
