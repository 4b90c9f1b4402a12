#include "preprocess/model_format/point_node.h"

#include "preprocess/model_format/half.h"
#include "preprocess/model_format/octahedral.h"
#include "preprocess/model_format/packed_surfel.h"
#include "preprocess/model_format/tangent_frame.h"

#include <algorithm>
#include <numbers>

namespace splice {
namespace {

using format::PackedPointNode;
using format::PointNode;

constexpr unsigned kNormalBits = 12;
constexpr std::uint32_t kNormalMask = (1u << 2 * kNormalBits) - 1;
constexpr int kDirections = 256;  // in half a turn
constexpr double kDirectionStep = std::numbers::pi / kDirections;
constexpr float kRatioSteps = 255;
// A ratio that is a whole step but for single precision's rounding stays that step.
constexpr float kRatioSlack = 3e-5f;
constexpr float kLargestHalf = 65504;
constexpr unsigned kInner = 128;

std::uint32_t direction_of(const std::array<float, 3>& axis, const TangentFrame& frame) {
    double along_s = 0, along_t = 0;
    for (std::size_t k = 0; k < 3; ++k) {
        along_s += static_cast<double>(axis[k]) * static_cast<double>(frame.s[k]);
        along_t += static_cast<double>(axis[k]) * static_cast<double>(frame.t[k]);
    }
    return static_cast<std::uint32_t>(std::lround(std::atan2(along_t, along_s) / kDirectionStep)) & (kDirections - 1);
}

// Cosine and sine of each direction.
std::array<std::array<float, 2>, kDirections> direction_table() {
    std::array<std::array<float, 2>, kDirections> table{};
    for (std::size_t direction = 0; direction < table.size(); ++direction) {
        const auto turn = static_cast<float>(static_cast<double>(direction) * kDirectionStep);
        table[direction] = {std::cos(turn), std::sin(turn)};
    }
    return table;
}

std::uint32_t axis_at(std::uint32_t direction, const TangentFrame& frame) {
    static const auto table = direction_table();
    const auto [c, s] = table[direction];
    return encode_octahedral(c * frame.s[0] + s * frame.t[0], c * frame.s[1] + s * frame.t[1],
                             c * frame.s[2] + s * frame.t[2]);
}

// The minor half axis in steps of the major one.
std::uint8_t ratio_of(float minor, float major) {
    const float ratio = major > 0 ? minor / major : 1;
    return static_cast<std::uint8_t>(std::clamp(std::ceil(ratio * kRatioSteps - kRatioSlack), 0.0f, kRatioSteps));
}

std::uint16_t half_length(float length) {
    return half_at_least(std::min(length, kLargestHalf));
}

float minor_of(std::uint8_t ratio, float major) {
    return major * static_cast<float>(ratio) / kRatioSteps;
}

// All but the links.
PointNode unpack(const PackedPointNode& packed) {
    PointNode node{};
    unpack_place(packed.place, node.position);
    node.major = float_from_half(packed.major);
    node.minor = minor_of(packed.ratio, node.major);
    node.sphere_radius = float_from_half(packed.sphere_radius);
    node.normal = lengthen_normal<kNormalBits>(packed.frame & kNormalMask);
    node.major_axis = axis_at(packed.frame >> 24, tangents_of(decode_octahedral(node.normal)));
    std::copy_n(packed.colour, 3, node.colour);
    node.cone_angle = packed.cone_angle;
    node.extent = packed.extent;
    return node;
}

}  // namespace

void round_place(PointNode& node) {
    const auto place = pack_place(node.position);
    unpack_place({place[0], place[1]}, node.position);
    node.normal = lengthen_normal<kNormalBits>(shorten_normal<kNormalBits>(node.normal));
}

void round_axis(PointNode& node) {
    const TangentFrame frame = tangents_of(decode_octahedral(node.normal));
    node.major_axis = axis_at(direction_of(decode_octahedral(node.major_axis), frame), frame);
}

void round_lengths(PointNode& node) {
    node.major = float_from_half(half_length(node.major));
    node.minor = minor_of(ratio_of(node.minor, node.major), node.major);
    node.sphere_radius = float_from_half(half_length(node.sphere_radius));
}

PackedPointNode pack_point_node(const PointNode& node) {
    PackedPointNode packed{};
    std::ranges::copy(pack_place(node.position), packed.place);
    packed.major = half_length(node.major);
    packed.sphere_radius = half_length(node.sphere_radius);
    const std::uint32_t normal = shorten_normal<kNormalBits>(node.normal);
    const TangentFrame frame = tangents_of(decode_octahedral(lengthen_normal<kNormalBits>(normal)));
    packed.frame = normal | direction_of(decode_octahedral(node.major_axis), frame) << 24;
    packed.ratio = ratio_of(node.minor, float_from_half(packed.major));
    std::copy_n(node.colour, 3, packed.colour);
    packed.cone_angle = node.cone_angle;
    packed.extent = node.extent;
    packed.below = static_cast<std::uint8_t>(node.child_count != 0 ? kInner + node.child_count : node.surfel_count);
    return packed;
}

std::vector<PackedPointNode> pack_point_tree(std::span<const PointNode> nodes) {
    std::vector<PackedPointNode> packed(nodes.size());
    std::ranges::transform(nodes, packed.begin(), pack_point_node);
    return packed;
}

std::vector<PointNode> unpack_point_tree(std::span<const PackedPointNode> packed) {
    std::vector<PointNode> nodes(packed.size());
    std::uint32_t next = 1;
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        nodes[i] = unpack(packed[i]);
        if (packed[i].below > kInner) {
            nodes[i].child_count = static_cast<std::uint8_t>(packed[i].below - kInner);
            nodes[i].first_child = next;
            next += nodes[i].child_count;
        } else {
            nodes[i].surfel_count = packed[i].below;
        }
    }
    // Counts come up from the leaves, beginnings down from the root.
    for (std::size_t i = nodes.size(); i-- > 0;)
        for (std::uint32_t child = 0; child < nodes[i].child_count; ++child)
            nodes[i].surfel_count += nodes[nodes[i].first_child + child].surfel_count;
    for (PointNode& node : nodes) {
        std::uint32_t first = node.first_surfel;
        for (std::uint32_t child = 0; child < node.child_count; ++child) {
            nodes[node.first_child + child].first_surfel = first;
            first += nodes[node.first_child + child].surfel_count;
        }
    }
    return nodes;
}

}  // namespace splice
