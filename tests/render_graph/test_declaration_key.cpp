// The key of a declaration stands for it in the cache of plans: equal keys exactly where the declarations are equal.
#include "engine/render_graph/graph.h"
#include "tests/render_graph/random_graph.h"

#include <catch2/catch.hpp>
#include <rapidcheck.h>

#include <vector>

namespace {

using namespace splice;
using graph::Contents;
using graph::PassKind;

constexpr VkFormat kColour = VK_FORMAT_R8G8B8A8_UNORM;

std::vector<uint32_t> random_tape() {
    const auto numbers =
        *rc::gen::resize(40, rc::gen::container<std::vector<uint32_t>>(rc::gen::arbitrary<uint32_t>()));
    std::vector<uint32_t> tape;
    for (const uint32_t number : numbers) {
        for (uint32_t i = 0; i < 6; ++i)
            tape.push_back((number * (2 * i + 1)) * 2654435761U >> 7);
    }
    return tape;
}

void check_equal_or_not(const graph::Graph& a, const graph::Graph& b) {
    RC_ASSERT((a.key() == b.key()) == (a.declaration() == b.declaration()));
}

/// From a few building blocks that differ in little, so that many pairs are alike in all but one step.
void declare_steps(graph::Graph& graph, const std::vector<uint8_t>& steps) {
    const graph::ImageHandle depth = graph.import_image(
        "depth", {VK_FORMAT_D32_SFLOAT, 64, 64}, {.before = {{}, VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL}});
    graph::BufferHandle list = graph.import_buffer("list", {64}, {});
    graph::Pass pass = graph.add_pass("first", PassKind::graphics);
    for (const uint8_t step : steps) {
        try {
            switch (step % 8) {
                case 0:
                case 1:
                case 2:
                    pass = graph.add_pass("pass", static_cast<PassKind>(step % 8));
                    break;
                case 3:
                    pass.depth_stencil_read(depth);
                    break;
                case 4:
                    pass.storage_read(list);
                    break;
                case 5:
                    list = pass.storage_write(list, Contents::discard());
                    break;
                case 6:
                    pass.side_effect();
                    break;
                default:
                    graph.import_buffer("another", {64}, {.wanted = step < 128});
            }
        } catch (const graph::GraphError&) {  // leaves the graph as it was
        }
    }
}

}  // namespace

TEST_CASE("random declarations have equal keys exactly where they are equal") {
    REQUIRE(rc::check("pairs", [] {
        graph::Graph a, b;
        test::declare_random(a, random_tape());
        test::declare_random(b, random_tape());
        check_equal_or_not(a, b);
    }));
    REQUIRE(rc::check("one number changed", [] {
        const std::vector<uint32_t> tape = random_tape();
        RC_PRE(!tape.empty());
        std::vector<uint32_t> changed = tape;
        changed[*rc::gen::inRange<size_t>(0, tape.size())] += *rc::gen::inRange(0U, 8U);
        graph::Graph a, b;
        test::declare_random(a, tape);
        test::declare_random(b, changed);
        check_equal_or_not(a, b);
    }));
    REQUIRE(rc::check("few steps", [] {
        const auto steps = *rc::gen::container<std::vector<uint8_t>>(rc::gen::arbitrary<uint8_t>());
        auto others = steps;
        if (!others.empty()) others[*rc::gen::inRange<size_t>(0, others.size())] = *rc::gen::arbitrary<uint8_t>();
        graph::Graph a, b;
        declare_steps(a, steps);
        declare_steps(b, others);
        check_equal_or_not(a, b);
    }));
}

TEST_CASE("a frame declared anew has the key that it had") {
    REQUIRE(rc::check("cleared", [] {
        const std::vector<uint32_t> tape = random_tape();
        graph::Graph kept, other;
        test::declare_random(kept, tape);
        const graph::DeclarationKey key = kept.key();
        test::declare_random(other, random_tape());
        other.clear();
        test::declare_random(other, tape);
        RC_ASSERT(other.declaration() == kept.declaration());
        RC_ASSERT(other.key() == key);
    }));
}

TEST_CASE("names, clear values and record functions are no part of the key") {
    graph::Graph a, b;
    for (graph::Graph* graph : {&a, &b}) {
        const bool first = graph == &a;
        const graph::ImageHandle image = graph->create_image(first ? "one" : "another", {kColour, 8, 8});
        graph::Pass pass = graph->add_pass(first ? "draw" : "paint", PassKind::graphics);
        pass.colour_attachment(image, Contents::clear(graph::clear_colour(first ? 0 : 1, 0, 0, 0)));
        if (first) pass.record([](const graph::PassContext&) {});
    }
    CHECK(a.key() == b.key());
}

TEST_CASE("empty passes do not pass for the accesses of another pass") {
    // The two words of such an access are the kinds of an empty compute and an empty transfer pass.
    const auto declare = [](graph::Graph& graph, bool reads) {
        const graph::ImageHandle colour = graph.create_image("colour", {kColour, 64, 64});
        const graph::ImageHandle depth =
            graph.import_image("depth", {VK_FORMAT_D32_SFLOAT, 64, 64},
                               {.before = {{VK_PIPELINE_STAGE_LATE_FRAGMENT_TESTS_BIT, 0},
                                           VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL}});
        graph::Pass draw = graph.add_pass("draw", PassKind::graphics);
        draw.colour_attachment(colour, Contents::discard());
        if (reads) {
            draw.depth_stencil_read(depth);
        } else {
            graph.add_pass("empty compute", PassKind::compute);
            graph.add_pass("empty transfer", PassKind::transfer);
        }
    };
    graph::Graph a, b;
    declare(a, true);
    declare(b, false);
    CHECK_FALSE(a.key() == b.key());
}
