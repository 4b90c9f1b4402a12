// Compiled without contraction to fused multiply-adds, so that every processor computes the same distances.
#include "preprocess/cloud/near_block.h"

#include "preprocess/cloud/near_block_vectors.h"

#include <algorithm>

namespace splice {
namespace {

float squared_length(float x, float y, float z) {
    return x * x + y * y + z * z;
}

unsigned near_boxes(const BoxGroup& group, const Box3& box, float farthest) {
    unsigned near = 0;
    for (std::size_t i = 0; i < kGroupBoxes; ++i) {
        const auto gap = [&](std::size_t axis) {
            return std::max(std::max(group.low[axis][i] - box.high[axis], box.low[axis] - group.high[axis][i]), 0.0f);
        };
        near |= static_cast<unsigned>(squared_length(gap(0), gap(1), gap(2)) <= farthest) << i;
    }
    return near;
}

void settle(NearLists& lists, std::size_t q) {
    Neighbour* list = lists.first + q * lists.stride;
    for (std::size_t i = 0; i < lists.aside[q]; ++i) {
        const Neighbour found = make_neighbour(lists.squared[q][i], lists.index[q][i]);
        // Into its place without a branch, from the far end: an entry becomes the middle one of itself, the one before,
        // and what was found.
        for (std::size_t place = lists.stride; place-- > 1;)
            list[place] = std::max(list[place - 1], std::min(list[place], found));
        list[0] = std::min(list[0], found);
    }
    update_reach(lists, q);
}

bool add(const PointBlock& own, const PointBlock& other, const Box3& box, std::uint32_t first_index, bool same,
         NearLists& lists) {
    bool settled = false;
    for (std::size_t q = 0; q < kBlockPoints; ++q) {
        const float x = own.x[q], y = own.y[q], z = own.z[q];
        const auto beyond = [&](std::size_t axis, float value) {
            return std::max(std::max(box.low[axis] - value, value - box.high[axis]), 0.0f);
        };
        if (squared_length(beyond(0, x), beyond(1, y), beyond(2, z)) > lists.reach[q]) continue;
        if (is_full(lists, q)) {
            settle(lists, q);
            settled = true;
        }
        for (std::size_t i = 0; i < kBlockPoints; ++i) {
            const float squared = squared_length(other.x[i] - x, other.y[i] - y, other.z[i] - z);
            const std::size_t place = lists.aside[q];
            lists.squared[q][place] = squared;
            lists.index[q][place] = first_index + static_cast<std::uint32_t>(i);
            lists.aside[q] += squared <= lists.reach[q] && !(same && i == q);
        }
    }
    return settled;
}

}  // namespace

NearFunctions near_functions([[maybe_unused]] bool wide) {
#ifdef SPLICE_NEAR_VECTORS
    if (wide && __builtin_cpu_supports("avx2") != 0 && __builtin_cpu_supports("popcnt") != 0)
        return near_functions_avx2();
#endif
    return {near_boxes, add, settle};
}

}  // namespace splice
