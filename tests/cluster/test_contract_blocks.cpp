#include "preprocess/cluster/cluster_mesh.h"
#include "preprocess/cluster/contract_blocks.h"
#include "preprocess/mesh/shapes.h"
#include "tests/cluster/cluster_fixture.h"

#include <catch2/catch.hpp>
#include <tbb/global_control.h>

#include <cstring>
#include <map>
#include <numeric>
#include <tuple>

using namespace splice;
using namespace splice::test;

namespace {

ClusterLevel level_of(const FaceGraph& faces) {
    ClusterLevel level;
    level.clusters = ClusterTable(faces).take();
    level.rough.assign(faces.size(), 0);
    for (std::size_t s = 0; s < faces.size() / 3; ++s)
        level.rough[s] = 1;
    level.nodes = faces.face_of_slot;
    level.links = faces.links;
    level.slot_of_face.resize(faces.size());
    std::iota(level.slot_of_face.begin(), level.slot_of_face.end(), 0u);
    return level;
}

ClusterLimits limits_of(const FaceGraph& faces) {
    const float area = std::accumulate(faces.area.begin(), faces.area.end(), 0.0f);
    return {20 * area / static_cast<float>(faces.size()), 25, 0.3f};
}

using Merge = std::tuple<std::uint32_t, std::uint32_t, float, std::uint32_t>;

std::vector<Merge> merges_of(const std::vector<format::MergeNode>& tree) {
    std::vector<Merge> merges;
    for (const format::MergeNode& n : tree)
        merges.emplace_back(n.child[0], n.child[1], n.cost, n.phase);
    return merges;
}

/// FlatnessMetric for one block: pairs that reach out of it are excluded.
struct InsideBlock {
    FlatnessMetric& metric;
    std::uint32_t first, last;

    bool inside(std::uint32_t slot) const { return slot >= first && slot < last; }
    float bound(std::uint32_t a, std::uint32_t b, float length) const {
        return inside(a) && inside(b) ? metric.bound(a, b, length) : kNever;
    }
    static float cost(std::uint32_t, std::uint32_t, float bound) { return bound; }
    void merge(std::uint32_t a, std::uint32_t b, float length) { metric.merge(a, b, length); }
};

/// Block after block, all pairs of the whole graph at each step.
void contract_naively(ClusterGraph& graph, FlatnessMetric& all, float threshold, std::uint32_t block) {
    for (std::uint32_t first = 0; first < graph.slots(); first += block) {
        InsideBlock metric{all, first, first + block};
        for (;;) {
            std::tuple best{kNever, ~0u, ~0u};
            for (std::uint32_t a = 0; a < graph.slots(); ++a) {
                if (!graph.alive(a)) continue;
                for (const ClusterLink& l : graph.links(a)) {
                    if (l.slot > a) best = std::min(best, std::tuple{metric.bound(a, l.slot, l.length), a, l.slot});
                }
            }
            const auto [cost, a, b] = best;
            if (cost > threshold || cost == kNever) break;
            metric.merge(a, b, graph.merge(a, b, cost, 1));
        }
    }
}

std::vector<IndexedMesh> small_meshes() {
    std::vector<IndexedMesh> meshes;
    meshes.push_back(random_blob(9, 7));
    meshes.push_back(repaired(shapes::cube(5)));  // full of ties
    meshes.push_back(repaired(shapes::machined_part(16)));
    meshes.push_back(repaired(shapes::terrain(12)));
    return meshes;
}

bool same_tree(const PatchSet& a, const PatchSet& b) {
    return a.merge_tree.size() == b.merge_tree.size() &&
           std::memcmp(a.merge_tree.data(), b.merge_tree.data(), a.merge_tree.size() * sizeof(format::MergeNode)) == 0;
}

}  // namespace

TEST_CASE("Blocks contract in the naive order of pairs inside them, and what is left is joined up") {
    for (const IndexedMesh& mesh : small_meshes()) {
        for (const std::uint32_t block : {7u, 64u, 1u << 20}) {
            const FaceGraph faces = graph_of(mesh);
            const ClusterLevel start = level_of(faces);
            const ClusterLevel level = contract_blocks(start, limits_of(faces), 0.1f, block);

            ClusterGraph naive(faces);
            ClusterTable table(faces);
            FlatnessMetric metric(table, start.rough, limits_of(faces));
            contract_naively(naive, metric, 0.1f, std::min(block, static_cast<std::uint32_t>(faces.size())));
            REQUIRE(!level.tree.empty());
            REQUIRE(merges_of(level.tree) == merges_of(naive.tree()));

            std::vector<std::uint32_t> alive, slot(faces.size());
            for (std::uint32_t s = 0; s < faces.size(); ++s) {
                slot[s] = naive.alive(s) ? static_cast<std::uint32_t>(alive.size()) : slot[naive.merged_into(s)];
                if (naive.alive(s)) alive.push_back(s);
            }
            REQUIRE(level.slot_of_face == slot);
            REQUIRE(level.nodes.size() == alive.size());
            std::map<std::pair<std::uint32_t, std::uint32_t>, float> borders;
            for (std::uint32_t n = 0; n < alive.size(); ++n) {
                CHECK(level.nodes[n] == naive.node(alive[n]));
                CHECK(level.rough[n] == start.rough[alive[n]]);
                CHECK(level.clusters[n].faces == table[alive[n]].faces);
                CHECK(level.clusters[n].shape.area == table[alive[n]].shape.area);
                for (const ClusterLink& l : naive.links(alive[n])) {
                    if (slot[l.slot] > n) borders[{n, slot[l.slot]}] = l.length;
                }
            }
            REQUIRE(level.links.size() == borders.size());
            auto border = borders.begin();  // ascending, as links are
            for (const FaceGraph::Link& l : level.links) {
                REQUIRE(std::pair(l.slot[0], l.slot[1]) == border->first);
                CHECK(l.length == Approx(border->second).epsilon(1e-5));
                ++border;
            }
        }
    }
}

TEST_CASE("A second level goes on from the first") {
    const IndexedMesh mesh = random_blob(12, 11);
    const FaceGraph faces = graph_of(mesh);
    const ClusterLevel first = contract_blocks(level_of(faces), limits_of(faces), -0.2f, 100);
    const ClusterLevel second = contract_blocks(first, limits_of(faces), 0.4f, 100);
    REQUIRE(second.tree.size() > first.tree.size());
    REQUIRE(second.nodes.size() + second.tree.size() == faces.size());
    // Each node is made of older ones and used once.
    std::vector<int> used(faces.size() + second.tree.size(), 0);
    for (std::size_t i = 0; i < second.tree.size(); ++i) {
        for (const std::uint32_t child : second.tree[i].child) {
            REQUIRE(child < faces.size() + i);
            CHECK(++used[child] == 1);
        }
    }
    for (const std::uint32_t node : second.nodes)
        CHECK(++used[node] == 1);
    // What a node stands for is what began in its slot.
    std::vector<std::uint32_t> faces_in(second.nodes.size(), 0);
    for (const std::uint32_t slot : second.slot_of_face)
        ++faces_in[slot];
    for (std::size_t n = 0; n < second.nodes.size(); ++n)
        CHECK(faces_in[n] == second.clusters[n].faces);
}

TEST_CASE("Meshes of several blocks cluster the same on one thread and on two") {
    const IndexedMesh mesh = repaired(shapes::terrain(110));
    REQUIRE(mesh.triangles.size() > 20'000);
    const auto cluster_on = [&](std::size_t threads) {
        const tbb::global_control control(tbb::global_control::max_allowed_parallelism, threads);
        return cluster_mesh(mesh, {});
    };
    const PatchSet one = cluster_on(1), two = cluster_on(2);
    REQUIRE(one.patches.size() > 1);
    CHECK(same_tree(one, two));
    CHECK(one.triangle_patch == two.triangle_patch);
    // A tree of merges of whole clusters: as many as faces that are no patch of their own.
    CHECK(one.merge_tree.size() + one.patches.size() == mesh.triangles.size());
}
