#include "engine/bench/graph/families.h"
#include "engine/bench/graph/memory_model.h"
#include "engine/render_graph/compile.h"
#include "engine/render_graph/plan_statistics.h"

#include <catch2/catch.hpp>

using namespace splice;
using bench::LiveBytes;

TEST_CASE("the lower bound is the most that is alive in one group") {
    CHECK(bench::peak_live_bytes({}) == 0);
    CHECK(bench::peak_live_bytes(std::vector<LiveBytes>{{0, 0, 5}}) == 5);
    // One after the other.
    CHECK(bench::peak_live_bytes(std::vector<LiveBytes>{{0, 1, 5}, {2, 3, 7}, {4, 4, 6}}) == 7);
    // Both ends belong to the life.
    CHECK(bench::peak_live_bytes(std::vector<LiveBytes>{{0, 1, 5}, {1, 3, 7}, {3, 4, 6}}) == 13);
    // A long one under two short ones, in any order.
    CHECK(bench::peak_live_bytes(std::vector<LiveBytes>{{8, 9, 3}, {0, 9, 10}, {2, 2, 4}}) == 14);
    // More than 32 bits.
    const uint64_t large = uint64_t{3} << 31;
    CHECK(bench::peak_live_bytes(std::vector<LiveBytes>{{0, 5, large}, {5, 6, large}}) == 2 * large);
}

TEST_CASE("resources take whole pages: small ones of 4 KiB, large ones of 64 KiB") {
    graph::Graph graph;
    graph.create_image("a texel", {VK_FORMAT_R8G8B8A8_UNORM, 1, 1});
    graph.create_image("16 pages", {VK_FORMAT_R8G8B8A8_UNORM, 128, 128});
    graph.create_image("a row more", {VK_FORMAT_R8G8B8A8_UNORM, 128, 129});
    graph.create_image("half floats", {VK_FORMAT_R16G16B16A16_SFLOAT, 64, 64});
    graph.create_buffer("a buffer", {4097});
    const auto needs = bench::memory_requirements(graph.declaration());
    REQUIRE(needs.size() == 5);
    CHECK(needs[0].size == 4096);
    CHECK(needs[0].alignment == 4096);
    CHECK(needs[1].size == 65536);
    CHECK(needs[1].alignment == 65536);
    CHECK(needs[2].size == 131072);
    CHECK(needs[3].size == 32768);
    CHECK(needs[4].size == 8192);
}

TEST_CASE("placed bytes lie between the lower bound and no aliasing, the plan's own figures agree") {
    for (const bench::Family& family : bench::families()) {
        for (const bool alias : {true, false}) {
            INFO(family.name << (alias ? "" : ", not aliased"));
            bench::FamilyOptions options;
            options.passes = 96;
            options.sizes = bench::ImageSizes::log_uniform;
            graph::Graph graph;
            family.declare(graph, options);
            const auto needs = bench::memory_requirements(graph.declaration());
            graph::CompileOptions compile_options;
            compile_options.alias = alias;
            compile_options.memory = [&](uint32_t resource, const graph::PlannedResource&) { return needs[resource]; };
            const graph::Plan plan = graph::compile(graph, compile_options);
            const bench::MemoryFigures use = bench::memory_use(graph.declaration(), plan, needs);
            CHECK(use.lower_bound > 0);
            CHECK(use.lower_bound <= use.placed);
            if (alias)
                CHECK(use.placed <= use.unaliased + (uint64_t{64} << 10) * plan.resources.size());  // gaps of pages
            else
                CHECK(use.placed >= use.unaliased);
            const graph::PlanStatistics statistics = graph::measure(graph, plan);
            CHECK(statistics.peak_live_bytes == use.lower_bound);
            CHECK(statistics.heap_bytes == use.placed);
            CHECK(statistics.unaliased_bytes == use.unaliased);
        }
    }
}
