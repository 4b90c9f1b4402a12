#include "preprocess/simplify/cluster_triangles.h"
#include "tests/simplify/patch_meshes.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <numeric>
#include <random>

using namespace splice;

namespace {

std::vector<ClusteredTriangle> shuffled_sphere() {
    const IndexedMesh mesh = test::bumpy_sphere(5, 0.02f);
    std::vector<ClusteredTriangle> triangles;
    for (const Triangle& t : mesh.triangles)
        triangles.push_back(clustered_triangle(mesh.positions[t[0]], mesh.positions[t[1]], mesh.positions[t[2]]));
    std::mt19937 random(3);
    std::ranges::shuffle(triangles, random);
    return triangles;
}

// Of each run, the least cosine of a normal with their mean, and the largest distance from the mean place; their means.
std::pair<double, double> spread(std::span<const ClusteredTriangle> triangles, std::span<const std::uint32_t> order) {
    double cosines = 0, widths = 0, runs = 0;
    for (std::size_t first = 0; first < order.size(); first += kClusterTriangles, ++runs) {
        const auto run = order.subspan(first, std::min(kClusterTriangles, order.size() - first));
        Vec3f normal = Vec3f::Zero(), place = Vec3f::Zero();
        for (const std::uint32_t t : run) {
            normal += triangles[t].normal;
            place += triangles[t].centroid / static_cast<float>(run.size());
        }
        float cosine = 1, width = 0;
        for (const std::uint32_t t : run) {
            cosine = std::min(cosine, triangles[t].normal.dot(normal.normalized()));
            width = std::max(width, (triangles[t].centroid - place).norm());
        }
        cosines += static_cast<double>(cosine);
        widths += static_cast<double>(width);
    }
    return {cosines / runs, widths / runs};
}

}  // namespace

TEST_CASE("runs of triangles in cluster order lie together and face the same way") {
    const std::vector<ClusteredTriangle> triangles = shuffled_sphere();
    const std::vector<std::uint32_t> order = cluster_order(triangles);
    std::vector<std::uint32_t> sorted = order, all(triangles.size());
    std::ranges::sort(sorted);
    std::iota(all.begin(), all.end(), 0u);
    REQUIRE(sorted == all);
    // 8,192 triangles are 128 runs: 13 degrees wide each, if they were round.
    const auto [cosine, width] = spread(triangles, order);
    const auto [before_cosine, before_width] = spread(triangles, all);
    CAPTURE(cosine, width, before_cosine, before_width);
    CHECK(cosine > 0.85);
    CHECK(width < 0.3 * before_width);
    CHECK(before_cosine < 0);
    for (std::size_t i = 1; i < order.size(); ++i)
        if (i % kClusterTriangles != 0) CHECK(order[i] > order[i - 1]);
}

TEST_CASE("few triangles, or none, or all at one place, have an order, too") {
    CHECK(cluster_order({}).empty());
    const std::vector<ClusteredTriangle> same(200, clustered_triangle({0, 0, 0}, {0, 0, 0}, {0, 0, 0}));
    std::vector<std::uint32_t> order = cluster_order(same);
    REQUIRE(order.size() == 200);
    std::ranges::sort(order);
    CHECK(order.back() == 199);
    CHECK(std::ranges::adjacent_find(order) == order.end());
}
