// What the kinds of vectors have in common. Only the files near_block*.cpp include this.
#pragma once

#include "preprocess/cloud/near_block.h"

#if defined(__x86_64__) && defined(__GNUC__)
#define SPLICE_NEAR_VECTORS 1
#endif

namespace splice {

inline void update_reach(NearLists& lists, std::size_t q) {
    // Of kNoNeighbour it is no number, and so not less.
    const float last = squared_distance_of(lists.first[q * lists.stride + lists.k - 1]);
    lists.reach[q] = last < lists.reach[q] ? last : lists.reach[q];
}

#ifdef SPLICE_NEAR_VECTORS
void add_near_points_avx2(const PointBlock& own, const PointBlock& other, std::uint32_t first_index, bool same,
                          NearLists& lists);
void add_near_points_avx512(const PointBlock& own, const PointBlock& other, std::uint32_t first_index, bool same,
                            NearLists& lists);
#endif

}  // namespace splice
