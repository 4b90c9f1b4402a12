#include "engine/bench/graph/families.h"
#include "engine/render_graph/compile.h"
#include "engine/render_graph/plan_statistics.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <set>

using namespace splice;
using bench::Family;

namespace {

Family family(std::string_view name) {
    for (const Family& one : bench::families())
        if (one.name == name) return one;
    FAIL("no family " << name);
    return {};
}

graph::Graph declare(std::string_view name, uint32_t passes, uint64_t seed = 1,
                     bench::ImageSizes sizes = bench::ImageSizes::log_uniform) {
    bench::FamilyOptions options;
    options.passes = passes;
    options.seed = seed;
    options.sizes = sizes;
    graph::Graph graph;
    family(name).declare(graph, options);
    return graph;
}

/// The passes whose images a pass reads, once for each image.
std::vector<uint32_t> sources(const graph::Graph& graph, uint32_t pass) {
    std::vector<uint32_t> writers(graph.declaration().resources.size(), graph::none), found;
    for (uint32_t earlier = 0; earlier < pass; ++earlier) {
        for (const graph::Access& access : graph.accesses(earlier))
            if (is_write(access.kind)) writers[access.resource] = earlier;
    }
    for (const graph::Access& access : graph.accesses(pass))
        if (!is_write(access.kind)) found.push_back(writers[access.resource]);
    return found;
}

size_t writes(const graph::Graph& graph, uint32_t pass) {
    const auto accesses = graph.accesses(pass);
    return static_cast<size_t>(
        std::count_if(accesses.begin(), accesses.end(), [](const graph::Access& a) { return is_write(a.kind); }));
}

size_t count_kind(const graph::Graph& graph, graph::AccessKind kind) {
    const auto& all = graph.declaration().accesses;
    return static_cast<size_t>(
        std::count_if(all.begin(), all.end(), [&](const graph::Access& access) { return access.kind == kind; }));
}

}  // namespace

TEST_CASE("every family has as many passes as asked for, and the compiler keeps all of them") {
    for (const Family& one : bench::families()) {
        for (const uint32_t passes : {4U, 5U, 9U, 31U, 33U, 64U, 100U, 257U}) {
            INFO(one.name << ", " << passes);
            const graph::Graph graph = declare(one.name, passes);
            CHECK(graph.declaration().passes.size() == passes);
            const graph::Plan plan = graph::compile(graph);
            CHECK(plan.order.size() == passes);
            CHECK(plan.culled.empty());
        }
    }
}

TEST_CASE("a family is the same for the same seed and has other sizes for another") {
    for (const Family& one : bench::families()) {
        INFO(one.name);
        CHECK(declare(one.name, 100, 7).declaration() == declare(one.name, 100, 7).declaration());
        CHECK(!(declare(one.name, 100, 7).declaration() == declare(one.name, 100, 8).declaration()));
    }
}

TEST_CASE("what records a pass is asked for each pass, before the next begins") {
    for (const Family& one : bench::families()) {
        INFO(one.name);
        std::vector<uint32_t> painted;
        bench::FamilyOptions options;
        options.passes = 40;
        options.paint = [&](graph::Graph&, graph::Pass& pass) {
            painted.push_back(pass.index());
            pass.record([](const graph::PassContext&) {});
        };
        graph::Graph graph;
        one.declare(graph, options);
        REQUIRE(painted.size() == 40);
        for (uint32_t pass = 0; pass < 40; ++pass)
            CHECK(painted[pass] == pass);
    }
}

TEST_CASE("chain: each pass samples the one before and nothing else") {
    const graph::Graph graph = declare("chain", 50);
    CHECK(sources(graph, 0).empty());
    for (uint32_t pass = 1; pass < 50; ++pass)
        CHECK(sources(graph, pass) == std::vector<uint32_t>{pass - 1});
}

TEST_CASE("fan: all but the ends sample the first, the last samples all of these") {
    const graph::Graph graph = declare("fan", 50);
    for (uint32_t pass = 1; pass < 49; ++pass)
        CHECK(sources(graph, pass) == std::vector<uint32_t>{0});
    std::vector<uint32_t> middle;
    for (uint32_t pass = 1; pass < 49; ++pass)
        middle.push_back(pass);
    CHECK(sources(graph, 49) == middle);
}

TEST_CASE("lattice: each cell samples its left and upper neighbours, the last pass the loose ends") {
    const graph::Graph graph = declare("lattice", 24);  // rows of 5: 5 + 5 + 5 + 5 + 3 cells
    CHECK(sources(graph, 0).empty());
    CHECK(sources(graph, 4) == std::vector<uint32_t>{3});
    CHECK(sources(graph, 5) == std::vector<uint32_t>{0});
    CHECK(sources(graph, 12) == std::vector<uint32_t>{11, 7});
    CHECK(sources(graph, 22) == std::vector<uint32_t>{21, 17});
    CHECK(sources(graph, 23) == std::vector<uint32_t>{19, 22});
}

TEST_CASE("layered: 2 or 3 different images of the three layers before, 1 or 2 written") {
    for (const char* name : {"layered", "layered-local"}) {
        INFO(name);
        const graph::Graph graph = declare(name, 801);
        std::set<size_t> read_counts, write_counts;
        for (uint32_t pass = 0; pass < 800; ++pass) {
            write_counts.insert(writes(graph, pass));
            if (pass < 8) {
                CHECK(sources(graph, pass).empty());
                continue;
            }
            const std::vector<uint32_t> from = sources(graph, pass);
            read_counts.insert(from.size());
            std::set<uint32_t> resources;
            for (const graph::Access& access : graph.accesses(pass))
                CHECK(resources.insert(access.resource).second);
            for (const uint32_t source : from) {
                CHECK(source / 8 < pass / 8);
                CHECK(source / 8 + 3 >= pass / 8);
            }
        }
        CHECK(read_counts == std::set<size_t>{2, 3});
        CHECK(write_counts == std::set<size_t>{1, 2});
    }
}

TEST_CASE("only the pixel-local one of the layered families merges") {
    const graph::Graph sampled = declare("layered", 256), local = declare("layered-local", 256);
    CHECK(count_kind(sampled, graph::AccessKind::input_attachment) == 0);
    CHECK(graph::measure(sampled, graph::compile(sampled)).merged_passes == 0);
    CHECK(count_kind(local, graph::AccessKind::input_attachment) > 20);
    CHECK(count_kind(local, graph::AccessKind::sampled) > 100);
    CHECK(graph::measure(local, graph::compile(local)).merged_passes > 10);
}

TEST_CASE("deferred: the lights of a view merge with its G-buffer, and the end of the bloom with the tone mapping") {
    const graph::Graph one = declare("deferred", 32);
    const graph::PlanStatistics plan = graph::measure(one, graph::compile(one));
    CHECK(plan.merged_groups == 2);
    CHECK(plan.merged_passes == 11 + 2);  // 10 lights
    CHECK(plan.groups == 32 - 13 + 2);
    const graph::Graph three = declare("deferred", 100);  // 32, 32 and 36 passes
    CHECK(std::count_if(three.declaration().resources.begin(), three.declaration().resources.end(),
                        [](const graph::ResourceDeclaration& resource) { return resource.imported; }) == 3);
    CHECK(graph::measure(three, graph::compile(three)).merged_groups == 6);
}

TEST_CASE("log-uniform sizes spread over all octaves of the area") {
    const graph::Graph graph = declare("chain", 4096);
    std::vector<int> octaves(12, 0);
    for (const graph::ResourceDeclaration& resource : graph.declaration().resources) {
        CHECK(resource.image.width == resource.image.height);
        CHECK(resource.image.width % 16 == 0);
        REQUIRE(resource.image.width >= 64);
        REQUIRE(resource.image.width <= 4096);
        const double log2_pixels = 2 * std::log2(static_cast<double>(resource.image.width));
        ++octaves[std::min(static_cast<size_t>(log2_pixels - 12), size_t{11})];
    }
    for (const int count : octaves)
        CHECK(count > 4096 / 12 / 2);
}

TEST_CASE("equal sizes are equal") {
    for (const char* name : {"chain", "fan", "lattice", "layered", "layered-local"}) {
        const graph::Graph graph = declare(name, 64, 1, bench::ImageSizes::equal);
        for (const graph::ResourceDeclaration& resource : graph.declaration().resources) {
            CHECK(resource.image.width == 1920);
            CHECK(resource.image.height == 1080);
        }
    }
}
