#include "preprocess/simplify/simplify_regions.h"
#include "tests/simplify/open_edges.h"
#include "tests/simplify/patch_meshes.h"

#include <catch2/catch.hpp>
#include <tbb/global_control.h>

#include <map>
#include <numeric>
#include <set>

using namespace splice;
using test::directed_edges;
using test::divide;
using test::Edge;
using test::open_edges;

namespace {

// A bumpy sphere in 64 patches; an octree of 8 nodes of 8 patches below the root.
struct Sphere {
    IndexedMesh mesh = test::bumpy_sphere(5, 0.02f);  // 8,192 triangles
    PatchSet patches;
    RenderVertices render;
    std::vector<std::uint32_t> order;
    std::vector<format::OctreeNode> octree;

    explicit Sphere(bool two_materials = false) {
        const auto label = [&](std::uint32_t triangle) {
            const Vec3f c = test::centroid(mesh, triangle);
            const auto octant = [](const Vec3f& p) {
                return (p.x() > 0 ? 1u : 0u) | (p.y() > 0 ? 2u : 0u) | (p.z() > 0 ? 4u : 0u);
            };
            // Within an octant, eight again, by thirds that all occur.
            const Vec3f a = c.cwiseAbs() / c.norm();
            return 8 * octant(c) + octant(Vec3f(a - Vec3f::Constant(0.5f)));
        };
        std::map<std::uint32_t, std::uint32_t> dense;
        for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t)
            dense.emplace(label(t), 0);
        std::map<std::uint32_t, std::uint32_t> patches_of_octant;
        std::uint32_t next = 0;
        for (auto& [key, value] : dense) {
            value = next++;
            ++patches_of_octant[key / 8];
        }
        patches = divide(mesh, [&](std::uint32_t triangle) { return dense.at(label(triangle)); });
        if (two_materials) patches.patches.front().material = 1;
        render = build_render_vertices(mesh);
        order.resize(patches.patches.size());
        std::iota(order.begin(), order.end(), 0u);
        octree.resize(9);
        octree[0].patch_count = next;
        octree[0].first_child = 1;
        octree[0].child_count = 8;
        std::uint32_t first = 0;
        for (std::uint32_t octant = 0; octant < 8; ++octant) {
            octree[1 + octant].first_patch = first;
            octree[1 + octant].patch_count = patches_of_octant.at(octant);
            first += patches_of_octant.at(octant);
        }
    }

    RegionLods simplify() const { return simplify_regions(mesh, render, patches, order, octree); }

    std::vector<std::uint32_t> finest(std::uint32_t node) const {
        std::vector<std::uint32_t> corners;
        for (std::uint32_t i = patches.patch_begin[octree[node].first_patch];
             i < patches.patch_begin[octree[node].first_patch + octree[node].patch_count]; ++i)
            for (std::size_t k = 0; k < 3; ++k)
                corners.push_back(render.indices[std::size_t{3} * patches.patch_triangles[i] + k]);
        return corners;
    }
};

std::span<const PatchLods::Level> levels_of(const RegionLods& lods, std::size_t node) {
    return std::span(lods.levels).subspan(lods.level_begin[node], lods.level_begin[node + 1] - lods.level_begin[node]);
}

std::span<const std::uint32_t> indices_of(const RegionLods& lods, const PatchLods::Level& level) {
    return std::span(lods.indices).subspan(level.first_index, level.index_count);
}

}  // namespace

TEST_CASE("levels of several patches together keep the node's border, edge by edge, and go far below it") {
    const Sphere sphere;
    const RegionLods lods = sphere.simplify();
    REQUIRE(lods.level_begin.size() == 10);
    for (std::uint32_t node = 0; node < 9; ++node) {
        CAPTURE(node);
        const std::vector<std::uint32_t> finest = sphere.finest(node);
        const std::set<Edge> border = open_edges(finest);
        CHECK(border.empty() == (node == 0));
        const auto levels = levels_of(lods, node);
        REQUIRE(levels.size() >= 2);
        std::size_t before = finest.size();
        float error = 0;
        for (const PatchLods::Level& level : levels) {
            CHECK(static_cast<double>(level.index_count) <= 0.9 * static_cast<double>(before));
            CHECK(level.error >= error);
            CHECK(level.error > 0);
            CHECK(open_edges(indices_of(lods, level)) == border);
            for (const auto& [edge, count] : directed_edges(indices_of(lods, level)))
                if (count != 1) FAIL("edge " << edge.first << " " << edge.second << " used " << count << " times");
            before = level.index_count;
            error = level.error;
        }
        // The inner borders of patches are no longer there.
        CHECK(static_cast<double>(before) < (node == 0 ? 0.02 : 0.35) * static_cast<double>(finest.size()));
    }
    // The root begins with more than what is left of its children: none of it is held by their borders.
    std::size_t left = 0;
    for (std::uint32_t node = 1; node < 9; ++node)
        left += levels_of(lods, node).back().index_count;
    CHECK(levels_of(lods, 0).front().error <= levels_of(lods, 1).back().error);
    CHECK(levels_of(lods, 0)[1].index_count < left);
    CHECK(levels_of(lods, 0).front().index_count <= sphere.finest(0).size() / 3);
}

TEST_CASE("levels of several patches do not depend on the threads") {
    const Sphere sphere;
    const RegionLods lods = sphere.simplify();
    const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
    const RegionLods again = sphere.simplify();
    CHECK(again.indices == lods.indices);
    CHECK(again.level_begin == lods.level_begin);
}

TEST_CASE("patches of different materials are not simplified together") {
    const RegionLods lods = Sphere(true).simplify();
    CHECK(levels_of(lods, 0).empty());
    CHECK(levels_of(lods, 1).empty());
    CHECK(!levels_of(lods, 8).empty());
}
