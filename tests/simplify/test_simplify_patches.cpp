#include "preprocess/simplify/simplify_patches.h"
#include "tests/simplify/open_edges.h"
#include "tests/simplify/patch_meshes.h"

#include <catch2/catch.hpp>
#include <tbb/global_control.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <set>

using namespace splice;
using test::directed_edges;
using test::divide;
using test::Edge;
using test::open_edges;

namespace {

struct Simplified {
    IndexedMesh mesh;
    PatchSet patches;
    RenderVertices render;
    PatchLods lods;

    Simplified(IndexedMesh m, PatchSet p, const SimplifyOptions& options = {})
        : mesh(std::move(m)),
          patches(std::move(p)),
          render(build_render_vertices(mesh)),
          lods(simplify_patches(mesh, render, patches, options)) {}

    std::span<const PatchLods::Level> levels(std::size_t patch) const {
        return std::span(lods.levels)
            .subspan(lods.patch_begin[patch], lods.patch_begin[patch + 1] - lods.patch_begin[patch]);
    }
    std::span<const std::uint32_t> indices(const PatchLods::Level& level) const {
        return std::span(lods.indices).subspan(level.first_index, level.index_count);
    }
    Vec3f position(std::uint32_t vertex) const { return mesh.positions[render.position[vertex]]; }
};

void check_levels(const Simplified& s) {
    std::uint64_t finest_begin = 0;
    for (std::size_t patch = 0; patch < s.patches.patches.size(); ++patch) {
        const auto levels = s.levels(patch);
        REQUIRE(!levels.empty());
        CHECK(levels[0].first_index == finest_begin);
        finest_begin += levels[0].index_count;
        CHECK(levels[0].error == 0.0f);
        const std::set<Edge> border = open_edges(s.indices(levels[0]));
        for (std::size_t i = 1; i < levels.size(); ++i) {
            INFO("patch " << patch << " level " << i);
            CHECK(static_cast<double>(levels[i].index_count) <= 0.9 * levels[i - 1].index_count);
            CHECK(levels[i].error >= levels[i - 1].error);
            // No crack: the border's edges, and so its vertices, are the finest level's, bit for bit.
            CHECK(open_edges(s.indices(levels[i])) == border);
            // No fold or doubled triangle: each directed edge at most once.
            for (const auto& [edge, count] : directed_edges(s.indices(levels[i])))
                if (count != 1) FAIL("edge " << edge.first << " " << edge.second << " used " << count << " times");
        }
    }
    CHECK(finest_begin == 3 * s.mesh.triangles.size());
}

float waves(float x, float y) {
    return 0.05f * std::sin(11 * x) * std::cos(9 * y);
}

// Quarters of the square, jagged where they meet.
std::uint32_t quarter(const IndexedMesh& mesh, std::uint32_t triangle) {
    const Vec3f c = test::centroid(mesh, triangle);
    const float jag = 0.03f * std::sin(60 * (c.x() + c.y()));
    return (c.x() + jag > 0 ? 1u : 0u) + (c.y() - jag > 0 ? 2u : 0u);
}

Vec3f face_normal(const Simplified& s, std::span<const std::uint32_t> triangle) {
    return (s.position(triangle[1]) - s.position(triangle[0])).cross(s.position(triangle[2]) - s.position(triangle[0]));
}

}  // namespace

TEST_CASE("neighbouring patches keep their common border at every level") {
    const IndexedMesh mesh = test::height_field(48, waves);
    const Simplified s(mesh, divide(mesh, [&](std::uint32_t t) { return quarter(mesh, t); }));
    check_levels(s);
    for (std::size_t patch = 0; patch < 4; ++patch)
        CHECK(s.levels(patch).size() >= 3);
}

TEST_CASE("no level turns a triangle over") {
    const IndexedMesh mesh = test::height_field(48, waves);
    const Simplified s(mesh, divide(mesh, [&](std::uint32_t t) { return quarter(mesh, t); }));
    for (const PatchLods::Level& level : s.lods.levels) {
        const auto indices = s.indices(level);
        for (std::size_t i = 0; i < indices.size(); i += 3)
            CHECK(face_normal(s, indices.subspan(i, 3)).z() > 0);
    }
}

TEST_CASE("a level covers the same ground as the finest") {
    const IndexedMesh mesh = test::height_field(32, waves);
    const Simplified s(mesh, divide(mesh, [](std::uint32_t) { return 0u; }));
    for (const PatchLods::Level& level : s.levels(0)) {
        double projected_area = 0;
        const auto indices = s.indices(level);
        for (std::size_t i = 0; i < indices.size(); i += 3)
            projected_area += static_cast<double>(face_normal(s, indices.subspan(i, 3)).z()) / 2;
        CHECK(projected_area == Approx(1).epsilon(1e-5));
    }
}

TEST_CASE("a closed patch stays closed and keeps its genus") {
    const IndexedMesh mesh = test::bumpy_sphere(4, 0.05f);
    const Simplified s(mesh, divide(mesh, [](std::uint32_t) { return 0u; }));
    check_levels(s);
    REQUIRE(s.levels(0).size() == 4);
    for (const PatchLods::Level& level : s.levels(0)) {
        const auto indices = s.indices(level);
        const std::set<std::uint32_t> vertices(indices.begin(), indices.end());
        const auto edges = directed_edges(indices).size() / 2;
        CHECK(vertices.size() + indices.size() / 3 == edges + 2);  // Euler
        CHECK(open_edges(indices).empty());
    }
}

TEST_CASE("levels shrink by the asked factor where borders allow it") {
    const IndexedMesh mesh = test::bumpy_sphere(5, 0.02f);
    const Simplified s(mesh, divide(mesh, [](std::uint32_t) { return 0u; }));
    const auto levels = s.levels(0);
    REQUIRE(levels.size() == 4);
    for (std::size_t i = 1; i < 4; ++i) {
        const double ratio = static_cast<double>(levels[i].index_count) / levels[i - 1].index_count;
        CHECK(ratio == Approx(0.25).epsilon(0.15));
    }
}

TEST_CASE("the number of levels is what is asked for") {
    const IndexedMesh mesh = test::height_field(40, waves);
    const PatchSet patches = divide(mesh, [](std::uint32_t) { return 0u; });
    for (const std::uint32_t levels : {1u, 2u, 3u, 4u}) {
        SimplifyOptions options;
        options.levels = levels;
        options.reduction = 0.5f;
        CHECK(Simplified(mesh, patches, options).levels(0).size() == levels);
    }
}

TEST_CASE("flat ground is simplified without error, to its border") {
    const IndexedMesh mesh = test::height_field(16, [](float, float) { return 0.0f; });
    const Simplified s(mesh, divide(mesh, [](std::uint32_t) { return 0u; }));
    check_levels(s);
    const PatchLods::Level& coarsest = s.levels(0).back();
    CHECK(coarsest.error < 1e-6f);
    CHECK(coarsest.index_count / 3 < 100);  // 62 suffice for 64 border vertices
}

TEST_CASE("the error grows with what was lost") {
    const IndexedMesh gentle = test::height_field(40, [](float x, float y) { return 0.1f * waves(x, y); });
    const IndexedMesh steep = test::height_field(40, waves);
    const auto whole = [](std::uint32_t) { return 0u; };
    const Simplified a(gentle, divide(gentle, whole)), b(steep, divide(steep, whole));
    CHECK(a.levels(0).back().error > 0);
    CHECK(a.levels(0).back().error < b.levels(0).back().error);
    CHECK(b.levels(0).back().error < 0.1f);  // the whole height is 0.1
}

TEST_CASE("texture seams and creases inside a patch survive") {
    IndexedMesh mesh = test::height_field(24, waves);
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
        const bool right = test::centroid(mesh, t).x() > 0;
        for (const std::uint32_t v : mesh.triangles[t])
            mesh.corner_uvs.push_back(mesh.positions[v].head<2>() + Vec2f(right ? 5.0f : 0.0f, 0));
    }
    const Simplified s(mesh, divide(mesh, [](std::uint32_t) { return 0u; }));
    CHECK(s.render.vertices.size() == mesh.positions.size() + 25);
    check_levels(s);  // the seam's edges are open in the index buffer
    CHECK(s.levels(0).size() >= 3);
}

TEST_CASE("a colour edge holds longer than plain ground") {
    IndexedMesh mesh = test::height_field(32, [](float, float) { return 0.0f; });
    const auto colour = [](const Vec3f& p) {
        return p.x() * p.x() + p.y() * p.y() < 0.04f ? 0xff0000ffu : 0xffffffffu;
    };
    for (const Triangle& t : mesh.triangles)
        for (const std::uint32_t v : t)
            mesh.corner_colours.push_back(colour(mesh.positions[v]));
    const Simplified s(mesh, divide(mesh, [](std::uint32_t) { return 0u; }));
    REQUIRE(s.levels(0).size() >= 2);
    const auto indices = s.indices(s.levels(0)[1]);
    double red_area = 0;
    for (std::size_t i = 0; i < indices.size(); i += 3) {
        double red = 0;
        for (std::size_t k = 0; k < 3; ++k)
            red += s.render.vertices[indices[i + k]].colour == 0xff0000ffu;
        red_area += red / 3 * static_cast<double>(face_normal(s, indices.subspan(i, 3)).z()) / 2;
    }
    CHECK(red_area == Approx(M_PI * 0.04).epsilon(0.15));
}

TEST_CASE("levels do not depend on the number of threads") {
    const IndexedMesh mesh = test::height_field(48, waves);
    const auto build = [&](std::size_t threads) {
        const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
        return Simplified(mesh, divide(mesh, [&](std::uint32_t t) { return quarter(mesh, t); }));
    };
    const Simplified one = build(1), four = build(4);
    CHECK(one.lods.indices == four.lods.indices);
    CHECK(one.lods.patch_begin == four.lods.patch_begin);
    for (std::size_t i = 0; i < one.lods.levels.size(); ++i)
        CHECK(one.lods.levels[i].error == four.lods.levels[i].error);
}

TEST_CASE("awkward patches pass through") {
    const auto whole = [](std::uint32_t) { return 0u; };
    SECTION("one triangle") {
        const IndexedMesh mesh = test::mesh_of({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}});
        const Simplified s(mesh, divide(mesh, whole));
        CHECK(s.levels(0).size() == 1);
    }
    SECTION("a tetrahedron is not folded flat") {
        const IndexedMesh mesh =
            test::mesh_of({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}});
        const Simplified s(mesh, divide(mesh, whole));
        CHECK(s.levels(0).size() == 1);
    }
    SECTION("four faces on an edge") {
        const IndexedMesh mesh = test::mesh_of({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, -1, 0}, {0, 0, -1}},
                                               {{0, 1, 2}, {0, 1, 3}, {0, 1, 4}, {0, 1, 5}});
        check_levels(Simplified(mesh, divide(mesh, whole)));
    }
    SECTION("triangles turned over at random") {
        IndexedMesh mesh = test::height_field(16, waves);
        for (std::size_t t = 0; t < mesh.triangles.size(); t += 7)
            std::swap(mesh.triangles[t][0], mesh.triangles[t][1]);
        const Simplified s(mesh, divide(mesh, whole));
        const std::set<Edge> border = open_edges(s.indices(s.levels(0)[0]));
        for (const PatchLods::Level& level : s.levels(0))
            CHECK(open_edges(s.indices(level)) == border);
    }
    SECTION("a patch of two pieces that touch in one vertex") {
        const IndexedMesh mesh = test::height_field(16, waves);
        const auto checker = [&](std::uint32_t t) {
            const Vec3f c = test::centroid(mesh, t);
            return (c.x() > 0) == (c.y() > 0) ? 0u : 1u;
        };
        check_levels(Simplified(mesh, divide(mesh, checker)));
    }
    SECTION("a hub of many thousand triangles") {
        const IndexedMesh mesh = test::fan(20000);
        check_levels(Simplified(mesh, divide(mesh, whole)));
    }
}

TEST_CASE("random patches never crack") {
    for (unsigned seed = 0; seed < 20; ++seed) {
        const IndexedMesh mesh = test::bumpy_sphere(3, 0.01f * static_cast<float>(seed % 7));
        // Voronoi cells of a few pseudo-random directions
        std::vector<Vec3f> seeds;
        for (unsigned i = 0; i < 3 + seed % 5; ++i) {
            const auto n = static_cast<float>(seed * 31 + i * 17);
            seeds.push_back(Vec3f(std::sin(n), std::sin(2.3f * n), std::cos(1.7f * n)).normalized());
        }
        const auto cell = [&](std::uint32_t t) {
            const auto nearest =
                std::ranges::max_element(seeds, {}, [&](const Vec3f& d) { return d.dot(test::centroid(mesh, t)); });
            return static_cast<std::uint32_t>(nearest - seeds.begin());
        };
        INFO("seed " << seed);
        check_levels(Simplified(mesh, divide(mesh, cell)));
    }
}
