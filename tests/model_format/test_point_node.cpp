#include "preprocess/model_format/octahedral.h"
#include "preprocess/model_format/point_node.h"

#include <catch2/catch.hpp>

#include <cmath>
#include <cstring>
#include <random>

using namespace splice;
using format::PointNode;

namespace {

double dot(std::uint32_t a, std::uint32_t b) {
    const auto p = decode_octahedral(a), q = decode_octahedral(b);
    double sum = 0;
    for (std::size_t k = 0; k < 3; ++k)
        sum += static_cast<double>(p[k]) * static_cast<double>(q[k]);
    return sum;
}

PointNode random_node(std::mt19937& random) {
    std::uniform_real_distribution<float> share(0, 1);
    PointNode node{};
    for (float& coordinate : node.position)
        coordinate = share(random) - 0.5f;
    node.normal = encode_octahedral(share(random) - 0.5f, share(random) - 0.5f, share(random) - 0.5f);
    node.major_axis = encode_octahedral(share(random) - 0.5f, share(random) - 0.5f, share(random) - 0.5f);
    node.major = std::exp2(-18 * share(random));
    node.minor = node.major * share(random);
    node.sphere_radius = std::exp2(-18 * share(random));
    node.cone_angle = static_cast<std::uint8_t>(random());
    node.extent = static_cast<std::uint16_t>(random());
    node.colour[1] = static_cast<std::uint8_t>(random());
    return node;
}

void round_node(PointNode& node) {
    round_place(node);
    round_axis(node);
    round_lengths(node);
}

}  // namespace

TEST_CASE("rounding a point node never shrinks it, and rounding again changes nothing") {
    std::mt19937 random(5);
    for (int i = 0; i < 20000; ++i) {
        const PointNode node = random_node(random);
        PointNode rounded = node;
        round_node(rounded);
        const float step = 6.1e-8f;
        for (int axis = 0; axis < 3; ++axis)
            CHECK(std::abs(rounded.position[axis] - node.position[axis]) <= 0x1p-21f + 1e-7f);
        CHECK(std::acos(std::min(dot(rounded.normal, node.normal), 1.0)) < 0.06 * 0.01745329);
        CHECK(rounded.major >= node.major);
        CHECK(rounded.major <= node.major * 1.001f + step);
        CHECK(rounded.minor >= node.minor - 2e-7f * node.major);
        CHECK(rounded.minor <= node.minor + rounded.major / 254 + step);
        CHECK(rounded.minor <= rounded.major);
        CHECK(rounded.sphere_radius >= node.sphere_radius);
        CHECK(rounded.sphere_radius <= node.sphere_radius * 1.001f + step);
        CHECK(std::abs(dot(rounded.normal, rounded.major_axis)) < 2e-4);
        CHECK(rounded.cone_angle == node.cone_angle);
        CHECK(rounded.extent == node.extent);
        PointNode again = rounded;
        round_node(again);
        CHECK(std::memcmp(&again, &rounded, sizeof again) == 0);
    }
}

TEST_CASE("links and ranges of a point tree follow from its counts") {
    // A root of three children, the second an inner node of two leaves.
    std::mt19937 random(6);
    std::vector<PointNode> nodes;
    for (int i = 0; i < 6; ++i) {
        nodes.push_back(random_node(random));
        round_node(nodes.back());
    }
    const auto link = [&](std::size_t i, std::uint8_t children, std::uint32_t first_child, std::uint32_t first,
                          std::uint32_t count) {
        nodes[i].child_count = children;
        nodes[i].first_child = first_child;
        nodes[i].first_surfel = first;
        nodes[i].surfel_count = count;
    };
    link(0, 3, 1, 0, 127 + 9);
    link(1, 0, 0, 0, 1);
    link(2, 2, 4, 1, 8);
    link(3, 0, 0, 9, 127);
    link(4, 0, 0, 1, 3);
    link(5, 0, 0, 4, 5);
    const std::vector<PointNode> back = unpack_point_tree(pack_point_tree(nodes));
    REQUIRE(back.size() == nodes.size());
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        CAPTURE(i);
        CHECK(std::memcmp(&back[i], &nodes[i], sizeof(PointNode)) == 0);
    }
    CHECK(unpack_point_tree({}).empty());
}
