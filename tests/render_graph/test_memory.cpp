// Where transient resources lie: apart while they live together, in little more than the bytes alive at once.
#include "engine/bench/graph/families.h"
#include "engine/render_graph/compile.h"
#include "engine/render_graph/plan_statistics.h"
#include "tests/render_graph/hazard_checker.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

namespace {

using namespace splice;

constexpr uint64_t kAlignment = 256;

/// Of the families that splice-bench measures.
bench::Family family_of(std::string_view name) {
    const std::vector<bench::Family> all = bench::families();
    return *std::find_if(all.begin(), all.end(), [&](const bench::Family& family) { return family.name == name; });
}

void declare(graph::Graph& graph, const bench::Family& family, uint32_t passes, uint32_t seed) {
    family.declare(graph, {.passes = passes, .seed = seed, .sizes = bench::ImageSizes::log_uniform});
}

/// Four bytes a pixel.
std::vector<graph::MemoryRequirement> sizes_of(const graph::Graph& graph) {
    std::vector<graph::MemoryRequirement> sizes;
    for (const graph::ResourceDeclaration& resource : graph.declaration().resources) {
        const uint64_t bytes = uint64_t{4} * resource.image.width * resource.image.height;
        sizes.push_back({(bytes + kAlignment - 1) / kAlignment * kAlignment, kAlignment, 1});
    }
    return sizes;
}

struct Compiled {
    graph::Graph graph;
    std::vector<graph::MemoryRequirement> sizes;
    graph::CompileOptions options;
    graph::Plan plan;

    Compiled(const bench::Family& family, uint32_t passes, uint32_t seed, bool alias = true) {
        declare(graph, family, passes, seed);
        sizes = sizes_of(graph);
        options.alias = alias;
        options.memory = [this](uint32_t resource, const graph::PlannedResource&) { return sizes[resource]; };
        plan = graph::compile(graph, options);
    }
    double ratio() const {
        const graph::PlanStatistics statistics = graph::measure(graph, plan);
        return static_cast<double>(statistics.heap_bytes) / static_cast<double>(statistics.peak_live_bytes);
    }
};

bool overlap(const graph::PlannedResource& a, const graph::PlannedResource& b) {
    return a.lifetime.first_group <= b.lifetime.last_group && b.lifetime.first_group <= a.lifetime.last_group &&
           a.offset < b.offset + b.size && b.offset < a.offset + a.size;
}

}  // namespace

TEST_CASE("what lives together lies apart, aligned and within its heap, in frames of every shape and size") {
    for (const bench::Family& family : bench::families()) {
        for (const uint32_t passes : {4U, 40U, 400U, 1024U}) {
            const Compiled frame(family, passes, passes);
            CAPTURE(family.name, passes);
            const std::vector<graph::PlannedResource>& resources = frame.plan.resources;
            uint32_t faults = 0;
            for (size_t a = 0; a < resources.size(); ++a) {
                if (resources[a].heap == graph::none) continue;
                faults += resources[a].offset % kAlignment != 0 || resources[a].size != frame.sizes[a].size ||
                          resources[a].offset + resources[a].size > frame.plan.heaps[0].size;
                for (size_t b = a + 1; b < resources.size(); ++b)
                    faults += resources[b].heap != graph::none && overlap(resources[a], resources[b]);
            }
            CHECK(faults == 0);
        }
    }
}

TEST_CASE("frames of hundreds of passes have no hazard") {
    for (const bench::Family& family : bench::families()) {
        const Compiled frame(family, 300, 1);
        CHECK(test::find_hazards(frame.graph, frame.plan, frame.sizes).empty());
    }
}

TEST_CASE("memory stays within a tenth of the most that is alive at once") {
    for (const bench::Family& family : bench::families()) {
        for (const uint32_t passes : {16U, 64U, 256U, 1024U, 4096U}) {
            const uint32_t seeds = passes > 1000 ? 3 : 12;
            double worst = 0, sum = 0;
            for (uint32_t seed = 1; seed <= seeds; ++seed) {
                const double ratio = Compiled(family, passes, seed).ratio();
                worst = std::max(worst, ratio);
                sum += ratio;
            }
            CAPTURE(family.name, passes);
            CHECK(worst >= 1);
            CHECK(worst <= 1.10);
            CHECK(sum / seeds <= 1.08);
        }
    }
}

TEST_CASE("without aliasing every resource has bytes of its own") {
    const Compiled frame(family_of("layered"), 200, 3, false);
    const graph::PlanStatistics statistics = graph::measure(frame.graph, frame.plan);
    CHECK(statistics.heap_bytes == statistics.unaliased_bytes);
    CHECK(statistics.peak_live_bytes < statistics.unaliased_bytes);
    const Compiled aliased(family_of("layered"), 200, 3);
    CHECK(graph::measure(aliased.graph, aliased.plan).heap_bytes < statistics.heap_bytes / 3);
}

TEST_CASE("resources of one size share no more bytes than are alive at once") {
    graph::Graph graph;
    declare(graph, family_of("layered"), 500, 9);
    graph::CompileOptions options;
    options.memory = [](uint32_t, const graph::PlannedResource&) { return graph::MemoryRequirement{5000, 64, 1}; };
    const graph::Plan plan = graph::compile(graph, options);
    const graph::PlanStatistics statistics = graph::measure(graph, plan);
    CHECK(statistics.heap_bytes <= statistics.peak_live_bytes / 5000 * 5056);
}

TEST_CASE("times are told by phase and change nothing") {
    const Compiled frame(family_of("deferred"), 60, 2);
    graph::CompileTimings timings;
    timings.phases.resize(3);
    CHECK(graph::compile(frame.graph, frame.options, &timings) == frame.plan);
    std::string names;
    uint64_t total = 0;
    for (const graph::CompileTimings::Phase& phase : timings.phases) {
        names += std::string(phase.name) + " ";
        total += phase.nanoseconds;
    }
    CHECK(names == "validate cull dependencies merge order lifetimes render passes memory barriers ");
    CHECK(timings.total_nanoseconds() == total);
    CHECK(total > 0);
}

TEST_CASE("a declaration equals its like and nothing else") {
    graph::Graph a, b, c;
    declare(a, family_of("layered"), 100, 1);
    declare(b, family_of("layered"), 100, 1);
    declare(c, family_of("layered"), 100, 2);
    CHECK(a.declaration() == b.declaration());
    CHECK(a.key() == b.key());
    CHECK_FALSE(a.declaration() == c.declaration());
    CHECK_FALSE(a.key() == c.key());
    b.add_pass("one more", graph::PassKind::compute);
    CHECK_FALSE(a.declaration() == b.declaration());
    CHECK_FALSE(a.key() == b.key());
    b.clear();
    declare(b, family_of("layered"), 100, 1);
    CHECK(a.key() == b.key());
}

TEST_CASE("the key of a declaration tells every part of it, in whatever order what is independent is declared") {
    const graph::ImageDescription small{VK_FORMAT_R8G8B8A8_UNORM, 64, 64}, large{VK_FORMAT_R8G8B8A8_UNORM, 128, 64};
    const auto declare = [&](const graph::ImageDescription& size, const graph::ImportOptions& options,
                             graph::Contents contents, bool late, bool effect) {
        graph::Graph graph;
        graph::ImageHandle image{};
        if (!late) image = graph.import_image("image", size, options);
        graph::Pass pass = graph.add_pass("pass", graph::PassKind::graphics);
        if (late) image = graph.import_image("image", size, options);
        if (effect && late) pass.side_effect();
        pass.colour_attachment(image, contents);
        if (effect) pass.side_effect();
        return graph;
    };
    const graph::ImportOptions plain, read{.after = graph::external::host_read()}, scratch{.wanted = false};
    const auto discard = graph::Contents::discard(), clear = graph::Contents::clear({});
    const graph::Graph base = declare(small, plain, discard, false, false);
    CHECK(base.key() == declare(small, plain, discard, true, false).key());
    CHECK_FALSE(base.key() == declare(large, plain, discard, false, false).key());
    CHECK_FALSE(base.key() == declare(small, read, discard, false, false).key());
    CHECK_FALSE(base.key() == declare(small, scratch, discard, false, false).key());
    CHECK_FALSE(base.key() == declare(small, plain, clear, false, false).key());
    CHECK_FALSE(base.key() == declare(small, plain, discard, false, true).key());
    CHECK(declare(small, plain, discard, false, true).key() == declare(small, plain, discard, true, true).key());
}

TEST_CASE("random orders differ by their seed, and batches are taken apart into one barrier a command") {
    Compiled frame(family_of("layered"), 100, 4);
    CHECK(std::is_sorted(frame.plan.order.begin(), frame.plan.order.end()));
    const graph::PlanStatistics batched = graph::measure(frame.graph, frame.plan);
    frame.options.random_order = 1;
    const graph::Plan one = graph::compile(frame.graph, frame.options);
    CHECK(one == graph::compile(frame.graph, frame.options));
    frame.options.random_order = 2;
    CHECK_FALSE(one.order == graph::compile(frame.graph, frame.options).order);
    CHECK_FALSE(std::is_sorted(one.order.begin(), one.order.end()));
    CHECK(one.order.size() == frame.plan.order.size());

    frame.options.random_order.reset();
    frame.options.batch_barriers = false;
    const graph::Plan single = graph::compile(frame.graph, frame.options);
    const graph::PlanStatistics apart = graph::measure(frame.graph, single);
    CHECK(batched.barrier_commands == frame.plan.groups.size() + 1);
    CHECK(apart.barrier_commands == apart.barriers);
    CHECK(apart.barrier_commands > batched.barrier_commands);
    CHECK(batched.barriers <= batched.barriers_one_per_access);
}
