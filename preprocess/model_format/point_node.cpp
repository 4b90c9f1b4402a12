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

std::uint32_t axis_at(std::uint32_t direction, const TangentFrame& frame) {
    const auto turn = static_cast<float>(direction * kDirectionStep);
    const float c = std::cos(turn), s = std::sin(turn);
    return encode_octahedral(c * frame.s[0] + s * frame.t[0], c * frame.s[1] + s * frame.t[1],
                             c * frame.s[2] + s * frame.t[2]);
}

PackedPointNode pack(const PointNode& node) {
    PackedPointNode packed{};
    std::ranges::copy(pack_place(node.position), packed.place);
    packed.major = half_at_least(std::min(node.major, kLargestHalf));
    packed.sphere_radius = half_at_least(std::min(node.sphere_radius, kLargestHalf));
    const std::uint32_t normal = shorten_normal(node.normal, kNormalBits);
    const TangentFrame frame = tangents_of(decode_octahedral(lengthen_normal(normal, kNormalBits)));
    packed.frame = normal | direction_of(decode_octahedral(node.major_axis), frame) << 24;
    const float ratio = node.major > 0 ? node.minor / float_from_half(packed.major) : 1;
    packed.ratio =
        static_cast<std::uint8_t>(std::clamp(std::ceil(ratio * kRatioSteps - kRatioSlack), 0.0f, kRatioSteps));
    std::copy_n(node.colour, 3, packed.colour);
    packed.cone_angle = node.cone_angle;
    packed.extent = node.extent;
    packed.below = static_cast<std::uint8_t>(node.child_count != 0 ? kInner + node.child_count : node.surfel_count);
    return packed;
}

// All but the links.
PointNode unpack(const PackedPointNode& packed) {
    PointNode node{};
    unpack_place(packed.place, node.position);
    node.major = float_from_half(packed.major);
    node.minor = node.major * static_cast<float>(packed.ratio) / kRatioSteps;
    node.sphere_radius = float_from_half(packed.sphere_radius);
    node.normal = lengthen_normal(packed.frame & kNormalMask, kNormalBits);
    node.major_axis = axis_at(packed.frame >> 24, tangents_of(decode_octahedral(node.normal)));
    std::copy_n(packed.colour, 3, node.colour);
    node.cone_angle = packed.cone_angle;
    node.extent = packed.extent;
    return node;
}

}  // namespace

void round_node(PointNode& node) {
    PointNode rounded = unpack(pack(node));
    rounded.child_count = node.child_count;
    rounded.first_child = node.first_child;
    rounded.first_surfel = node.first_surfel;
    rounded.surfel_count = node.surfel_count;
    node = rounded;
}

std::vector<PackedPointNode> pack_point_tree(std::span<const PointNode> nodes) {
    std::vector<PackedPointNode> packed(nodes.size());
    std::ranges::transform(nodes, packed.begin(), pack);
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
