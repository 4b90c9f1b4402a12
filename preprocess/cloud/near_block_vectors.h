// What plain code and vectors have in common. Only the files near_block*.cpp include this.
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
    lists.aside[q] = 0;
}

/// A block more may not fit.
inline bool is_full(const NearLists& lists, std::size_t q) {
    return lists.aside[q] > NearLists::kAside - kBlockPoints;
}

#ifdef SPLICE_NEAR_VECTORS
NearFunctions near_functions_avx2();
#endif

}  // namespace splice
