// Near blocks with 256-bit vectors: a block's 16 points are two vectors, a list of 16 neighbours is four.
#include "preprocess/cloud/near_block_vectors.h"

#ifdef SPLICE_NEAR_VECTORS

#include <immintrin.h>

namespace splice {
namespace {

constexpr std::size_t kLanes = 8, kHalf = kBlockPoints / 2;  // floats in a vector
constexpr std::size_t kWide = 4;                             // doubles in a vector
static_assert(kHalf == kLanes && kGroupBoxes == kLanes && kListStep % kWide == 0);

#define SPLICE_WIDE __attribute__((target("avx2,popcnt"), always_inline)) inline
#define SPLICE_WIDE_FUNCTION __attribute__((target("avx2,popcnt")))

// For each set of lanes: their numbers, side by side from the first on.
constexpr auto kSelect = [] {
    std::array<std::array<std::uint8_t, kLanes>, 1 << kLanes> table{};
    for (unsigned lanes = 0; lanes < table.size(); ++lanes) {
        std::size_t place = 0;
        for (std::uint8_t lane = 0; lane < kLanes; ++lane)
            if ((lanes >> lane & 1) != 0) table[lanes][place++] = lane;
    }
    return table;
}();

SPLICE_WIDE __m256 squared_length(__m256 x, __m256 y, __m256 z) {
    return _mm256_add_ps(_mm256_add_ps(_mm256_mul_ps(x, x), _mm256_mul_ps(y, y)), _mm256_mul_ps(z, z));
}

SPLICE_WIDE __m256 larger_or_zero(__m256 a, __m256 b) {
    return _mm256_max_ps(_mm256_max_ps(a, b), _mm256_setzero_ps());
}

// Which of eight values are at most the others.
SPLICE_WIDE unsigned at_most(__m256 values, __m256 others) {
    return static_cast<unsigned>(_mm256_movemask_ps(_mm256_cmp_ps(values, others, _CMP_LE_OQ)));
}

SPLICE_WIDE_FUNCTION unsigned near_boxes(const BoxGroup& group, const Box3& box, float farthest) {
    const auto gap = [&](std::size_t axis) SPLICE_WIDE_FUNCTION {
        return larger_or_zero(_mm256_sub_ps(_mm256_load_ps(group.low[axis].data()), _mm256_set1_ps(box.high[axis])),
                              _mm256_sub_ps(_mm256_set1_ps(box.low[axis]), _mm256_load_ps(group.high[axis].data())));
    };
    return at_most(squared_length(gap(0), gap(1), gap(2)), _mm256_set1_ps(farthest));
}

SPLICE_WIDE __m256 beyond(const float* values, float low, float high) {
    const __m256 value = _mm256_load_ps(values);
    return larger_or_zero(_mm256_sub_ps(_mm256_set1_ps(low), value), _mm256_sub_ps(value, _mm256_set1_ps(high)));
}

SPLICE_WIDE unsigned near_box(const PointBlock& own, const Box3& box, const NearLists& lists, std::size_t half) {
    const __m256 to_box = squared_length(beyond(own.x.data() + half, box.low[0], box.high[0]),
                                         beyond(own.y.data() + half, box.low[1], box.high[1]),
                                         beyond(own.z.data() + half, box.low[2], box.high[2]));
    return at_most(to_box, _mm256_load_ps(lists.reach.data() + half));
}

SPLICE_WIDE __m256 distances(const PointBlock& own, std::size_t q, const PointBlock& other, std::size_t half) {
    return squared_length(_mm256_sub_ps(_mm256_load_ps(other.x.data() + half), _mm256_set1_ps(own.x[q])),
                          _mm256_sub_ps(_mm256_load_ps(other.y.data() + half), _mm256_set1_ps(own.y[q])),
                          _mm256_sub_ps(_mm256_load_ps(other.z.data() + half), _mm256_set1_ps(own.z[q])));
}

// The chosen ones of eight, all stored as if they were.
SPLICE_WIDE void put_aside(NearLists& lists, std::size_t q, __m256 squared, std::uint32_t first_index,
                           unsigned chosen) {
    const __m256i lanes =
        _mm256_cvtepu8_epi32(_mm_loadl_epi64(reinterpret_cast<const __m128i*>(kSelect[chosen].data())));
    const std::size_t place = lists.aside[q];
    _mm256_storeu_ps(lists.squared[q].data() + place, _mm256_permutevar8x32_ps(squared, lanes));
    _mm256_storeu_si256(reinterpret_cast<__m256i*>(lists.index[q].data() + place),
                        _mm256_add_epi32(lanes, _mm256_set1_epi32(static_cast<int>(first_index))));
    lists.aside[q] = place + static_cast<unsigned>(__builtin_popcount(chosen));
}

// One vector of a sorted list after `found` was inserted; `before` is the entry in front of each.
SPLICE_WIDE __m256d inserted(__m256d list, __m256d before, __m256d found) {
    return _mm256_max_pd(before, _mm256_min_pd(list, found));
}

// The last entry of `before` and all but the last of `list`.
SPLICE_WIDE __m256d shifted(__m256d list, __m256d before) {
    return _mm256_shuffle_pd(_mm256_permute2f128_pd(before, list, 0x21), list, 0x5);
}

// A list of 16, which stays in registers.
SPLICE_WIDE void insert_into_16(Neighbour* list, const Neighbour* found, std::size_t count) {
    __m256d a = _mm256_load_pd(list), b = _mm256_load_pd(list + kWide), c = _mm256_load_pd(list + 2 * kWide),
            d = _mm256_load_pd(list + 3 * kWide);
    for (std::size_t i = 0; i < count; ++i) {
        const __m256d next = _mm256_broadcast_sd(found + i);
        d = inserted(d, shifted(d, c), next);
        c = inserted(c, shifted(c, b), next);
        b = inserted(b, shifted(b, a), next);
        a = inserted(a, shifted(a, _mm256_setzero_pd()), next);
    }
    _mm256_store_pd(list, a);
    _mm256_store_pd(list + kWide, b);
    _mm256_store_pd(list + 2 * kWide, c);
    _mm256_store_pd(list + 3 * kWide, d);
}

SPLICE_WIDE void insert_into(Neighbour* list, std::size_t stride, const Neighbour* found, std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) {
        const __m256d next = _mm256_broadcast_sd(found + i);
        __m256d before = _mm256_setzero_pd();
        for (std::size_t place = 0; place < stride; place += kWide) {
            const __m256d part = _mm256_load_pd(list + place);
            _mm256_store_pd(list + place, inserted(part, shifted(part, before), next));
            before = part;
        }
    }
}

// The bits of distance above those of index, of eight.
SPLICE_WIDE void join(Neighbour* to, const float* squared, const std::uint32_t* index) {
    // Halves are unpacked one by one.
    constexpr int kOrder = 0xd8;  // quarters 0 2 1 3
    const __m256i high = _mm256_permute4x64_epi64(_mm256_castps_si256(_mm256_load_ps(squared)), kOrder),
                  low = _mm256_permute4x64_epi64(_mm256_load_si256(reinterpret_cast<const __m256i*>(index)), kOrder);
    _mm256_store_pd(to, _mm256_castsi256_pd(_mm256_unpacklo_epi32(low, high)));
    _mm256_store_pd(to + kWide, _mm256_castsi256_pd(_mm256_unpackhi_epi32(low, high)));
}

SPLICE_WIDE_FUNCTION void settle(NearLists& lists, std::size_t q) {
    alignas(32) std::array<Neighbour, NearLists::kAside> found;
    for (std::size_t i = 0; i < lists.aside[q]; i += kLanes)
        join(found.data() + i, lists.squared[q].data() + i, lists.index[q].data() + i);
    Neighbour* list = lists.first + q * lists.stride;
    if (lists.stride == 4 * kWide) {
        insert_into_16(list, found.data(), lists.aside[q]);
    } else {
        insert_into(list, lists.stride, found.data(), lists.aside[q]);
    }
    update_reach(lists, q);
}

SPLICE_WIDE_FUNCTION bool add(const PointBlock& own, const PointBlock& other, const Box3& box,
                              std::uint32_t first_index, bool same, NearLists& lists) {
    bool settled = false;
    unsigned near = near_box(own, box, lists, 0) | near_box(own, box, lists, kHalf) << kHalf;
    for (; near != 0; near &= near - 1) {
        const auto q = static_cast<std::size_t>(std::countr_zero(near));
        if (is_full(lists, q)) {
            settle(lists, q);
            settled = true;
        }
        const __m256 low = distances(own, q, other, 0), high = distances(own, q, other, kHalf),
                     reach = _mm256_set1_ps(lists.reach[q]);
        unsigned hits = at_most(low, reach) | at_most(high, reach) << kHalf;
        if (same) hits &= ~(1u << q);
        put_aside(lists, q, low, first_index, hits & 0xffu);
        put_aside(lists, q, high, first_index + static_cast<std::uint32_t>(kHalf), hits >> kHalf);
    }
    return settled;
}

}  // namespace

NearFunctions near_functions_avx2() {
    return {near_boxes, add, settle};
}

}  // namespace splice

#endif
