#include "preprocess/build_model/patch_octree.h"

#include <algorithm>
#include <array>
#include <bit>
#include <limits>
#include <numeric>
#include <tuple>
#include <utility>

namespace splice {
namespace {

constexpr unsigned kBitsPerAxis = 21;  // three axes in 63 bits

std::uint64_t spread_bits(std::uint64_t x) {
    x &= 0x1fffff;
    x = (x | x << 32) & 0x001f00000000ffff;
    x = (x | x << 16) & 0x001f0000ff0000ff;
    x = (x | x << 8) & 0x100f00f00f00f00f;
    x = (x | x << 4) & 0x10c30c30c30c30c3;
    x = (x | x << 2) & 0x1249249249249249;
    return x;
}

std::uint64_t morton_code(const Vec3f& point, const Box& box) {
    const float longest = (box.max - box.min).maxCoeff();
    const float scale = longest > 0 ? static_cast<float>((1u << kBitsPerAxis) - 1) / longest : 0.0f;
    std::uint64_t code = 0;
    for (unsigned axis = 0; axis < 3; ++axis)
        code |= spread_bits(static_cast<std::uint64_t>(std::max(0.0f, (point[axis] - box.min[axis]) * scale))) << axis;
    return code;
}

using Range = std::pair<std::uint32_t, std::uint32_t>;  // begin, end

// Non-empty octants of the smallest cube that separates the range's centres; codes ascend. Patches that share one
// centre are divided evenly.
std::vector<Range> split(std::span<const std::uint64_t> codes, Range range) {
    const auto [begin, end] = range;
    std::vector<Range> parts;
    const std::uint64_t difference = codes[begin] ^ codes[end - 1];
    if (difference == 0) {
        const std::uint64_t count = end - begin;
        for (std::uint64_t i = 0; i < 8; ++i) {
            const auto first = static_cast<std::uint32_t>(begin + count * i / 8);
            const auto last = static_cast<std::uint32_t>(begin + count * (i + 1) / 8);
            if (first != last) parts.emplace_back(first, last);
        }
        return parts;
    }
    const unsigned shift = (static_cast<unsigned>(std::bit_width(difference)) - 1) / 3 * 3;
    for (std::uint32_t first = begin; first < end;) {
        std::uint32_t last = first + 1;
        while (last < end && codes[last] >> shift == codes[first] >> shift)
            ++last;
        parts.emplace_back(first, last);
        first = last;
    }
    return parts;
}

format::OctreeNode node_over(Range patches) {
    format::OctreeNode node{};
    node.first_patch = patches.first;
    node.patch_count = patches.second - patches.first;
    return node;
}

void store_bounds(format::OctreeNode& node, const Box& box) {
    for (int axis = 0; axis < 3; ++axis) {
        node.bounds_min[axis] = box.min[axis];
        node.bounds_max[axis] = box.max[axis];
    }
}

// Over patches in `order`, whose codes ascend.
std::vector<format::OctreeNode> build_nodes(std::span<const std::uint64_t> codes, std::span<const Box> bounds,
                                            std::span<const std::uint32_t> order) {
    std::vector<format::OctreeNode> nodes;
    nodes.push_back(node_over({0, static_cast<std::uint32_t>(order.size())}));
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        const Range range = {nodes[i].first_patch, nodes[i].first_patch + nodes[i].patch_count};
        if (nodes[i].patch_count <= kMaxLeafPatches) continue;
        nodes[i].first_child = static_cast<std::uint32_t>(nodes.size());
        for (const Range& part : split(codes, range)) {
            nodes.push_back(node_over(part));
            ++nodes[i].child_count;
        }
    }

    std::vector<Box> boxes(nodes.size());
    for (std::size_t i = nodes.size(); i-- > 0;) {  // children come after their parent
        const format::OctreeNode& node = nodes[i];
        if (node.child_count == 0)
            for (std::uint32_t place = 0; place < node.patch_count; ++place)
                boxes[i].add(bounds[order[node.first_patch + place]]);
        for (std::uint32_t child = 0; child < node.child_count; ++child)
            boxes[i].add(boxes[node.first_child + child]);
        store_bounds(nodes[i], boxes[i]);
    }
    return nodes;
}

}  // namespace

PatchOctree build_patch_octree(std::span<const Box> bounds) {
    const auto patch_count = static_cast<std::uint32_t>(bounds.size());
    Box centres;
    for (const Box& box : bounds)
        centres.add(Vec3f((box.min + box.max) / 2));

    std::vector<std::pair<std::uint64_t, std::uint32_t>> keys(patch_count);
    for (std::uint32_t patch = 0; patch < patch_count; ++patch)
        keys[patch] = {morton_code((bounds[patch].min + bounds[patch].max) / 2, centres), patch};
    std::ranges::sort(keys);

    PatchOctree octree;
    std::vector<std::uint64_t> codes(patch_count);
    octree.order.resize(patch_count);
    for (std::uint32_t place = 0; place < patch_count; ++place)
        std::tie(codes[place], octree.order[place]) = keys[place];

    octree.nodes = build_nodes(codes, bounds, octree.order);
    return octree;
}

std::vector<format::OctreeNode> build_octree_in_order(std::span<const Box> bounds) {
    std::vector<std::uint32_t> order(bounds.size());
    std::iota(order.begin(), order.end(), 0u);
    return build_nodes(std::vector<std::uint64_t>(bounds.size(), 0), bounds, order);
}

}  // namespace splice
