// Compiled without contraction to fused multiply-adds, so that every processor computes the same distances.
#include "preprocess/cloud/near_block.h"

#include "preprocess/cloud/near_block_vectors.h"

#include <algorithm>

namespace splice {

namespace {

void insert(Neighbour* list, std::size_t stride, Neighbour found) {
    // Into its place without a branch, from the far end: an entry becomes the middle one of itself, the one before, and
    // what was found.
    for (std::size_t place = stride; place-- > 1;) {
        const Neighbour smaller = std::min(list[place], found);
        list[place] = std::max(list[place - 1], smaller);
    }
    list[0] = std::min(list[0], found);
}

void add_near_points_plainly(const PointBlock& own, const PointBlock& other, std::uint32_t first_index, bool same,
                             NearLists& lists) {
    for (std::size_t q = 0; q < kBlockPoints; ++q) {
        const float reach = lists.reach[q], x = own.x[q], y = own.y[q], z = own.z[q];
        const float dx = std::max(std::max(other.low[0] - x, x - other.high[0]), 0.0f),
                    dy = std::max(std::max(other.low[1] - y, y - other.high[1]), 0.0f),
                    dz = std::max(std::max(other.low[2] - z, z - other.high[2]), 0.0f);
        if (dx * dx + dy * dy + dz * dz > reach) continue;
        std::array<float, kBlockPoints> squared;
        for (std::size_t i = 0; i < kBlockPoints; ++i) {
            const float to_x = other.x[i] - x, to_y = other.y[i] - y, to_z = other.z[i] - z;
            squared[i] = to_x * to_x + to_y * to_y + to_z * to_z;
        }
        if (same) squared[q] = std::numeric_limits<float>::infinity();
        // One bit a hit: a loop over hits alone mispredicts less than a branch a point.
        std::uint32_t hits = 0;
        for (std::size_t i = 0; i < kBlockPoints; ++i)
            hits |= static_cast<std::uint32_t>(squared[i] <= reach) << i;
        if (hits == 0) continue;
        for (; hits != 0; hits &= hits - 1) {
            const auto i = static_cast<std::size_t>(std::countr_zero(hits));
            insert(lists.first + q * lists.stride, lists.stride,
                   std::bit_cast<Neighbour>(std::uint64_t{std::bit_cast<std::uint32_t>(squared[i])} << 32 |
                                            (first_index + static_cast<std::uint32_t>(i))));
        }
        update_reach(lists, q);
    }
}

}  // namespace

#ifdef SPLICE_NEAR_VECTORS

AddNearPoints near_points_adder(NearVectors widest) {
    if (widest >= NearVectors::k512 && __builtin_cpu_supports("avx512f") != 0) return add_near_points_avx512;
    if (widest >= NearVectors::k256 && __builtin_cpu_supports("avx2") != 0) return add_near_points_avx2;
    return add_near_points_plainly;
}

#else

AddNearPoints near_points_adder(NearVectors) {
    return add_near_points_plainly;
}

#endif

}  // namespace splice
