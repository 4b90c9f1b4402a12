#include "engine/bench/graph/graph_layout.h"
#include "engine/bench/graph/random.h"

#include <catch2/catch.hpp>

#include <algorithm>

using namespace splice::bench;

TEST_CASE("a chain stands upright, each box below the one before") {
    std::vector<LayoutBox> boxes(3, {40});
    std::vector<LayoutLine> lines{{0, 1, {}}, {1, 2, {}}};
    CHECK(lay_out(boxes, lines, 10) == Approx(40));
    for (size_t i = 0; i < 3; ++i) {
        CHECK(boxes[i].layer == i);
        CHECK(boxes[i].x == Approx(20));
    }
}

TEST_CASE("a source stands just above the first box that needs it") {
    std::vector<LayoutBox> boxes(4, {40});
    std::vector<LayoutLine> lines{{0, 2, {}}, {1, 3, {}}, {2, 3, {}}};
    lay_out(boxes, lines, 10);
    CHECK(boxes[0].layer == 0);
    CHECK(boxes[1].layer == 1);
    CHECK(boxes[3].layer == 2);
}

TEST_CASE("in random graphs lines lead downwards and nothing overlaps") {
    Random random(3);
    for (int round = 0; round < 50; ++round) {
        std::vector<LayoutBox> boxes;
        std::vector<LayoutLine> lines;
        const uint32_t count = 1 + random.below(40);
        for (uint32_t i = 0; i < count; ++i) {
            boxes.push_back({20.0 + random.below(80)});
            for (uint32_t reads = random.below(4); i > 0 && reads > 0; --reads)
                lines.push_back({random.below(i), i, {}});
        }
        const double gap = 8, width = lay_out(boxes, lines, gap);
        for (const LayoutLine& line : lines) {
            REQUIRE(boxes[line.from].layer < boxes[line.to].layer);
            CHECK(line.x_between.size() == boxes[line.to].layer - boxes[line.from].layer - 1);
            for (const double x : line.x_between) {
                CHECK(x >= 0);
                CHECK(x <= width);
            }
        }
        for (const LayoutBox& a : boxes) {
            CHECK(a.x - a.width / 2 >= -1e-9);
            CHECK(a.x + a.width / 2 <= width + 1e-9);
            for (const LayoutBox& b : boxes) {
                if (&a == &b || a.layer != b.layer) continue;
                CHECK(std::abs(a.x - b.x) >= (a.width + b.width) / 2 + gap - 1e-6);
            }
        }
    }
}
