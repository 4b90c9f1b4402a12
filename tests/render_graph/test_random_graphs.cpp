// Properties of compile() over random frames, judged by a checker that shares nothing with it.
#include "engine/render_graph/compile.h"
#include "tests/render_graph/hazard_checker.h"
#include "tests/render_graph/plan_checker.h"
#include "tests/render_graph/random_graph.h"

#include <catch2/catch.hpp>
#include <rapidcheck.h>

#include <algorithm>
#include <memory>
#include <set>
#include <string>
#include <vector>

namespace {

using namespace splice;

struct Frame {
    graph::Graph graph;
    std::vector<graph::MemoryRequirement> memory;
    graph::CompileOptions options;
    graph::Plan plan;
};

/// A random frame of up to about 0.6 `length` passes, a half of which are kept, with random switches.
std::unique_ptr<Frame> random_frame(int length) {
    auto frame = std::make_unique<Frame>();
    const auto tape =
        *rc::gen::resize(length, rc::gen::container<std::vector<uint32_t>>(rc::gen::arbitrary<uint32_t>()));
    std::vector<uint32_t> numbers;
    for (const uint32_t number : tape) {
        // rapidcheck's integers are as small as the container; spread them, keep 0 at 0 so that shrinking works.
        for (uint32_t i = 0; i < 12; ++i)
            numbers.push_back((number * (2 * i + 1)) * 2654435761U >> 7);
    }
    test::declare_random(frame->graph, numbers);
    frame->options.cull = *rc::gen::weightedElement<bool>({{4, true}, {1, false}});
    frame->options.merge = *rc::gen::weightedElement<bool>({{4, true}, {1, false}});
    frame->options.alias = *rc::gen::weightedElement<bool>({{4, true}, {1, false}});
    frame->options.batch_barriers = *rc::gen::weightedElement<bool>({{4, true}, {1, false}});
    if (*rc::gen::weightedElement<bool>({{1, true}, {3, false}})) {
        frame->options.random_order = *rc::gen::arbitrary<uint64_t>();
    }
    frame->memory = test::random_sizes(frame->graph, *rc::gen::arbitrary<uint32_t>());
    if (*rc::gen::weightedElement<bool>({{4, true}, {1, false}})) {
        frame->options.memory = [memory = &frame->memory](uint32_t resource, const graph::PlannedResource&) {
            return (*memory)[resource];
        };
    }
    frame->options.max_input_attachments = 16;
    frame->plan = graph::compile(frame->graph, frame->options);
    return frame;
}

bool overlap(const Frame& frame, size_t a, size_t b) {
    const graph::PlannedResource &x = frame.plan.resources[a], &y = frame.plan.resources[b];
    return x.heap != graph::none && x.heap == y.heap && x.offset < y.offset + y.size && y.offset < x.offset + x.size;
}

bool shared_bytes(const Frame& frame) {
    for (size_t a = 0; a < frame.plan.resources.size(); ++a) {
        for (size_t b = 0; b < a; ++b) {
            if (overlap(frame, a, b)) return true;
        }
    }
    return false;
}

std::string joined(const std::vector<std::string>& lines) {
    std::string text;
    for (const std::string& line : lines)
        text += line + "\n";
    return text;
}

/// The first use of the resource in a group after this one finds contents that it reads or adds to.
bool needs_contents_after(const Frame& frame, uint32_t resource, uint32_t group) {
    for (uint32_t next = group; next < frame.plan.groups.size(); ++next) {
        for (const uint32_t pass : slice(frame.plan.order, frame.plan.groups[next].passes)) {
            for (const graph::Access& access : frame.graph.accesses(pass)) {
                if (access.resource != resource) continue;
                return next > group && (!graph::is_write(access.kind) || access.contents == graph::ContentsKind::keep);
            }
        }
    }
    return false;
}

}  // namespace

TEST_CASE("a compiled random frame has no hazard, no wrong layout and no lost contents") {
    REQUIRE(rc::check("no hazards", [] {
        const auto frame = random_frame(600);
        RC_CLASSIFY(frame->plan.order.size() > 100, "over 100 passes");
        RC_CLASSIFY(shared_bytes(*frame), "shared bytes");
        const std::vector<std::string> problems = test::find_hazards(frame->graph, frame->plan, frame->memory);
        if (!problems.empty()) RC_FAIL(joined(problems));
    }));
}

TEST_CASE("long frames that share much memory have no hazard") {
    uint32_t frames = 0, long_frames = 0, sharing = 0, slotted = 0;
    for (uint32_t seed = 1; seed <= 120; ++seed) {
        Frame frame;
        // The last ones are long enough for the packer to think of slots.
        test::declare_random(frame.graph, test::random_tape(seed > 115 ? 60000 : 60 * seed, seed));
        frame.memory = test::random_sizes(frame.graph, seed);
        frame.options.max_input_attachments = 16;
        frame.options.memory = [&](uint32_t resource, const graph::PlannedResource&) { return frame.memory[resource]; };
        if (seed % 4 == 0) frame.options.random_order = seed;
        frame.plan = graph::compile(frame.graph, frame.options);
        CAPTURE(seed);
        CHECK(joined(test::find_hazards(frame.graph, frame.plan, frame.memory)) == "");
        std::vector<uint32_t> tenants(frame.plan.heaps.size(), 0);
        for (const graph::PlannedResource& planned : frame.plan.resources) {
            if (planned.heap != graph::none) ++tenants[planned.heap];
        }
        ++frames;
        long_frames += frame.plan.order.size() > 100 ? 1 : 0;
        sharing += shared_bytes(frame) ? 1 : 0;
        slotted += std::any_of(tenants.begin(), tenants.end(), [](uint32_t count) { return count > 100; }) ? 1 : 0;
    }
    // What makes the above worth something.
    CAPTURE(frames, long_frames, sharing, slotted);
    CHECK(long_frames > frames / 2);
    CHECK(sharing > frames * 3 / 4);
    CHECK(slotted >= 3);
}

TEST_CASE("exactly the passes that something needs are kept") {
    REQUIRE(rc::check("culling", [] {
        const auto frame = random_frame(200);
        const std::set<uint32_t> needed = test::needed_passes(frame->graph);
        const std::set<uint32_t> kept(frame->plan.order.begin(), frame->plan.order.end());
        if (frame->options.cull) {
            RC_ASSERT(kept == needed);
        } else {
            RC_ASSERT(kept.size() == frame->graph.declaration().passes.size());
        }
        for (const graph::CulledPass& culled : frame->plan.culled) {
            RC_ASSERT(graph::explain(frame->graph, culled).find("is culled") != std::string::npos);
            if (culled.other != graph::none) {
                const bool reader = culled.reason == graph::CullReason::readers_culled;
                RC_ASSERT(reader == (kept.count(culled.other) == 0));
            }
        }
    }));
}

TEST_CASE("equal declarations compile to equal plans") {
    REQUIRE(rc::check("deterministic", [] {
        const auto frame = random_frame(200);
        RC_ASSERT(graph::compile(frame->graph, frame->options) == frame->plan);
    }));
}

TEST_CASE("no barrier is redundant: the checker misses each one that is dropped") {
    REQUIRE(rc::check("minimal", [] {
        const auto frame = random_frame(25);
        if (!frame->options.batch_barriers) return;  // made to cost more
        const auto drop = [&](graph::Range graph::BarrierBatch::*member, auto barriers) {
            for (size_t group = 0; group <= frame->plan.groups.size(); ++group) {
                graph::Plan mutant = frame->plan;
                graph::BarrierBatch& batch =
                    group < mutant.groups.size() ? mutant.groups[group].barriers : mutant.final_barriers;
                for (uint32_t i = 0; i < (batch.*member).count; ++i) {
                    mutant = frame->plan;
                    auto& list = mutant.*barriers;
                    const uint32_t at = (batch.*member).first + i;
                    // Made to do nothing, which keeps all ranges valid.
                    list[at].source = list[at].destination = {};
                    if constexpr (requires { list[at].old_layout; }) list[at].old_layout = list[at].new_layout;
                    if (test::find_hazards(frame->graph, mutant, frame->memory).empty()) {
                        RC_FAIL("a barrier of " + graph::quote_resource(frame->graph, list[at].resource) +
                                " before group " + std::to_string(group) + " is not needed");
                    }
                }
            }
        };
        drop(&graph::BarrierBatch::images, &graph::Plan::image_barriers);
        drop(&graph::BarrierBatch::buffers, &graph::Plan::buffer_barriers);
    }));
}

TEST_CASE("no dependency between subpasses is redundant, unless others lead the same way") {
    REQUIRE(rc::check("subpass dependencies", [] {
        const auto frame = random_frame(40);
        for (const graph::RenderPass& render_pass : frame->plan.render_passes) {
            const auto dependencies = slice(frame->plan.dependencies, render_pass.dependencies);
            for (uint32_t i = 0; i < dependencies.size(); ++i) {
                std::set<uint32_t> reached{dependencies[i].source};
                for (uint32_t j = 0; j < dependencies.size(); ++j) {
                    if (j != i && reached.count(dependencies[j].source) != 0)
                        reached.insert(dependencies[j].destination);
                }
                if (reached.count(dependencies[i].destination) != 0) continue;
                graph::Plan mutant = frame->plan;
                graph::SubpassDependency& dropped = mutant.dependencies[render_pass.dependencies.first + i];
                dropped.source_scope = dropped.destination_scope = {};
                RC_ASSERT(!test::find_hazards(frame->graph, mutant, frame->memory).empty());
            }
        }
    }));
}

TEST_CASE("a resource moved onto another that is alive is caught") {
    REQUIRE(rc::check("aliasing", [] {
        const auto frame = random_frame(40);
        const auto& resources = frame->plan.resources;
        for (uint32_t a = 0; a < resources.size(); ++a) {
            for (uint32_t b = 0; b < resources.size(); ++b) {
                if (a == b || resources[a].heap == graph::none || resources[a].heap != resources[b].heap) continue;
                const graph::Lifetime &x = resources[a].lifetime, &y = resources[b].lifetime;
                const bool apart = x.last_group < y.first_group || y.last_group < x.first_group;
                RC_ASSERT(!overlap(*frame, a, b) || (apart && frame->options.alias));
                RC_ASSERT(resources[a].offset % frame->memory[a].alignment == 0);
                RC_ASSERT(resources[a].offset + frame->memory[a].size <= frame->plan.heaps[resources[a].heap].size);
                // b begins within a's life, and what a holds then is needed later.
                if (!(x.first_group < y.first_group && needs_contents_after(*frame, a, y.first_group))) continue;
                graph::Plan mutant = frame->plan;
                mutant.resources[b].offset = mutant.resources[a].offset;
                RC_ASSERT(!test::find_hazards(frame->graph, mutant, frame->memory).empty());
            }
        }
    }));
}
