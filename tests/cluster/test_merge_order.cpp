#include "preprocess/cluster/cluster_metric.h"
#include "preprocess/cluster/merge_heap.h"
#include "preprocess/cluster/selection.h"
#include "preprocess/mesh/shapes.h"
#include "tests/cluster/cluster_fixture.h"

#include <catch2/catch.hpp>

#include <map>
#include <random>
#include <set>
#include <tuple>

using namespace splice;
using namespace splice::test;

namespace {

const auto everyone = [](std::uint32_t) { return true; };
const auto silent = [](std::size_t) {};

/// The algorithm without a heap: all pairs at each step.
template <class Metric, class Eligible>
std::size_t contract_naively(ClusterGraph& graph, Metric& metric, float threshold, std::uint32_t phase,
                             const Eligible& eligible) {
    for (std::size_t merges = 0;; ++merges) {
        std::tuple best{kNever, ~0u, ~0u};
        for (std::uint32_t a = 0; a < graph.slots(); ++a) {
            if (!graph.alive(a) || !eligible(a)) continue;
            for (const ClusterLink& l : graph.links(a)) {
                if (l.slot < a || !eligible(l.slot)) continue;
                const float bound = metric.bound(a, l.slot, l.length);
                if (bound == kNever) continue;
                best = std::min(best, std::tuple{metric.cost(a, l.slot, bound), a, l.slot});
            }
        }
        const auto [cost, a, b] = best;
        if (cost > threshold || cost == kNever) return merges;
        metric.merge(a, b, graph.merge(a, b, cost, phase));
    }
}

using Merge = std::tuple<std::uint32_t, std::uint32_t, float, std::uint32_t>;

std::vector<Merge> merges_of(const ClusterGraph& graph) {
    std::vector<Merge> merges;
    for (const format::MergeNode& n : graph.tree())
        merges.emplace_back(n.child[0], n.child[1], n.cost, n.phase);
    return merges;
}

float mean_area(const FaceGraph& faces) {
    float sum = 0;
    for (const float a : faces.area)
        sum += a;
    return sum / static_cast<float>(faces.size());
}

/// Both phases with and without the heap.
template <class MakeMetric>
void require_naive_order(const IndexedMesh& mesh, const MakeMetric& make_metric, float threshold) {
    const FaceGraph faces = graph_of(mesh);
    const float unit = 30 * mean_area(faces);

    ClusterGraph fast(faces), naive(faces);
    ClusterTable fast_table(faces), naive_table(faces);
    auto fast_metric = make_metric(faces, fast_table);
    auto naive_metric = make_metric(faces, naive_table);
    const std::size_t merges = contract(fast, fast_metric, threshold, 1, everyone, silent);
    REQUIRE(merges > 0);
    REQUIRE(merges == contract_naively(naive, naive_metric, threshold, 1, everyone));
    REQUIRE(merges_of(fast) == merges_of(naive));

    SizeMetric fast_size(fast_table, unit, 3 * unit), naive_size(naive_table, unit, 3 * unit);
    const auto most = [](std::uint32_t slot) { return slot % 7 != 0; };
    REQUIRE(contract(fast, fast_size, 0.9f, 2, most, silent) == contract_naively(naive, naive_size, 0.9f, 2, most));
    REQUIRE(merges_of(fast) == merges_of(naive));
}

std::vector<IndexedMesh> small_meshes() {
    std::vector<IndexedMesh> meshes;
    meshes.push_back(random_blob(9, 7));
    meshes.push_back(random_blob(12, 11));
    meshes.push_back(repaired(shapes::cube(5)));  // full of ties
    meshes.push_back(repaired(shapes::machined_part(16)));
    meshes.push_back(repaired(shapes::terrain(12)));
    return meshes;
}

}  // namespace

TEST_CASE("The heap contracts in the naive order: published cost") {
    for (const IndexedMesh& mesh : small_meshes()) {
        for (const float threshold : {-0.033f, 0.19f, 0.96f}) {
            require_naive_order(
                mesh,
                [&](const FaceGraph& faces, ClusterTable& table) {
                    return ThesisMetric(mesh, faces, table, 20 * mean_area(faces));
                },
                threshold);
        }
    }
}

TEST_CASE("The heap contracts in the naive order: geometric cost, two sides, limits") {
    for (const IndexedMesh& mesh : small_meshes()) {
        std::vector<std::uint8_t> rough(mesh.triangles.size(), 0);
        for (std::size_t s = 0; s < rough.size() / 2; ++s)
            rough[s] = 1;
        require_naive_order(
            mesh,
            [&](const FaceGraph& faces, ClusterTable& table) {
                return FlatnessMetric(table, rough, {20 * mean_area(faces), 25, 0.3f});
            },
            kNever);
    }
}

TEST_CASE("The heap contracts in the naive order: crumbs that change sides") {
    for (const IndexedMesh& mesh : small_meshes()) {
        const FaceGraph faces = graph_of(mesh);
        std::vector<float> scores(faces.size());
        std::vector<std::uint8_t> rough(faces.size());
        for (std::size_t s = 0; s < faces.size(); ++s) {
            scores[s] = 0.02f * static_cast<float>(s % 11);
            rough[s] = scores[s] > kRoughScore;
        }
        const ClusterLimits limits{8 * mean_area(faces), 30, 0.6f};
        const auto run = [&](const auto& contract_with) {
            ClusterGraph graph(faces);
            ClusterTable table(faces, scores);
            std::vector<std::uint8_t> side = rough;
            FlatnessMetric flatness(table, side, limits);
            contract_with(graph, flatness, 0.0f);
            CrumbMetric crumbs(table, side, kRoughScore, limits, 4 * mean_area(faces));
            contract_with(graph, crumbs, kNever);
            return std::pair(merges_of(graph), side);
        };
        const auto fast = run([](ClusterGraph& graph, auto& metric, float threshold) {
            contract(graph, metric, threshold, 1, everyone, silent);
        });
        const auto naive = run([](ClusterGraph& graph, auto& metric, float threshold) {
            contract_naively(graph, metric, threshold, 1, everyone);
        });
        REQUIRE(fast.second != rough);
        REQUIRE(fast == naive);
    }
}

TEST_CASE("A larger threshold merges more") {
    const IndexedMesh mesh = random_blob(12, 3);
    const FaceGraph faces = graph_of(mesh);
    std::size_t before = 0;
    for (const float threshold : {-0.96f, -0.3f, 0.033f, 0.19f, 0.96f}) {
        ClusterGraph graph(faces);
        ClusterTable table(faces);
        ThesisMetric metric(mesh, faces, table, 100);
        const std::size_t merges = contract(graph, metric, threshold, 1, everyone, silent);
        CHECK(merges >= before);
        before = merges;
    }
    CHECK(before > faces.size() / 2);
}

TEST_CASE("Clusters' sums after many merges equal sums over their faces") {
    const IndexedMesh mesh = random_blob(14, 5);
    const FaceGraph faces = graph_of(mesh);
    ClusterGraph graph(faces);
    ClusterTable table(faces);
    ThesisMetric metric(mesh, faces, table, 40 * mean_area(faces));
    contract(graph, metric, 0.5f, 1, everyone, silent);

    std::vector<std::uint32_t> root(faces.size());
    for (std::uint32_t s = 0; s < faces.size(); ++s)
        root[s] = graph.alive(s) ? s : root[graph.merged_into(s)];
    std::vector<double> area(faces.size(), 0), perimeter(faces.size(), 0);
    for (std::size_t s = 0; s < faces.size(); ++s) {
        area[root[s]] += static_cast<double>(faces.area[s]);
        perimeter[root[s]] += static_cast<double>(faces.perimeter[s]);
    }
    std::vector<std::map<std::uint32_t, double>> border(faces.size());
    for (const FaceGraph::Link& l : faces.links) {
        const std::uint32_t a = root[l.slot[0]], b = root[l.slot[1]];
        if (a == b) {
            perimeter[a] -= 2 * static_cast<double>(l.length);
        } else {
            border[a][b] += static_cast<double>(l.length);
            border[b][a] += static_cast<double>(l.length);
        }
    }
    for (std::uint32_t s = 0; s < faces.size(); ++s) {
        if (!graph.alive(s)) continue;
        CHECK(static_cast<double>(table[s].shape.area) == Approx(area[s]).epsilon(1e-4));
        CHECK(static_cast<double>(table[s].shape.perimeter) == Approx(perimeter[s]).epsilon(1e-3));
        REQUIRE(graph.links(s).size() == border[s].size());
        for (const ClusterLink& l : graph.links(s)) {
            CHECK(static_cast<double>(l.length) == Approx(border[s].at(l.slot)).epsilon(1e-4));
        }
    }
}

TEST_CASE("The pair queue yields pairs in order whatever the mix of pushes and pops") {
    struct Key {
        float cost;
        std::uint32_t a, b;
        bool operator<(const Key& o) const { return std::tuple(cost, a, b) < std::tuple(o.cost, o.a, o.b); }
    };
    std::mt19937 random(9);
    PairQueue queue(200);
    std::multiset<Key> reference;
    std::set<std::uint32_t> stale_names;
    const auto stale = [&](const QueuedPair& pair) { return stale_names.count(pair.time()) != 0; };
    // Coarse costs make ties; some lie beyond the buckets at either end.
    const auto cost = [&] { return static_cast<float>(static_cast<int>(random() % 97) - 48) / 12.0f; };
    for (std::uint32_t i = 0; i < 20000; ++i) {
        const Key key{cost(), static_cast<std::uint32_t>(random() % 50),
                      50 + static_cast<std::uint32_t>(random() % 50)};
        queue.push({key.cost, key.a, key.b, i % 2 == 0 ? key.a : key.b, i});
        if (random() % 5 == 0) {
            stale_names.insert(i);
        } else {
            reference.insert(key);
        }
        if (random() % 3 == 0 && !reference.empty()) {
            const QueuedPair* top = queue.top(stale);
            REQUIRE(top != nullptr);
            REQUIRE(top->owner() == (top->time() % 2 == 0 ? top->a() : top->b()));
            REQUIRE(top->other() == (top->time() % 2 == 0 ? top->b() : top->a()));
            REQUIRE(std::tuple(top->cost(), top->a(), top->b()) ==
                    std::tuple(reference.begin()->cost, reference.begin()->a, reference.begin()->b));
            reference.erase(reference.begin());
            queue.pop();
        }
    }
    while (const QueuedPair* top = queue.top(stale)) {
        REQUIRE(!reference.empty());
        REQUIRE(std::tuple(top->cost(), top->a(), top->b()) ==
                std::tuple(reference.begin()->cost, reference.begin()->a, reference.begin()->b));
        reference.erase(reference.begin());
        queue.pop();
    }
    REQUIRE(reference.empty());
}
