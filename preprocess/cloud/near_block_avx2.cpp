// Near blocks with 256-bit vectors: a block's 16 points are two vectors, a list of 16 neighbours is four.
#include "preprocess/cloud/near_block_vectors.h"

#ifdef SPLICE_NEAR_VECTORS

#include <immintrin.h>

namespace splice {
namespace {

constexpr std::size_t kLanes = 4;  // doubles in a vector
static_assert(kListStep % kLanes == 0 && kBlockPoints == 4 * kLanes);

#define SPLICE_WIDE __attribute__((target("avx2"), always_inline)) inline

SPLICE_WIDE __m256 beyond(__m256 value, float low, float high) {
    const __m256 farther =
        _mm256_max_ps(_mm256_sub_ps(_mm256_set1_ps(low), value), _mm256_sub_ps(value, _mm256_set1_ps(high)));
    return _mm256_max_ps(farther, _mm256_setzero_ps());
}

SPLICE_WIDE __m256 squared_length(__m256 x, __m256 y, __m256 z) {
    return _mm256_add_ps(_mm256_add_ps(_mm256_mul_ps(x, x), _mm256_mul_ps(y, y)), _mm256_mul_ps(z, z));
}

// Which of eight values are at most the others.
SPLICE_WIDE unsigned at_most(__m256 values, __m256 others) {
    return static_cast<unsigned>(_mm256_movemask_ps(_mm256_cmp_ps(values, others, _CMP_LE_OQ)));
}

SPLICE_WIDE unsigned near_box(const PointBlock& own, const PointBlock& other, const NearLists& lists,
                              std::size_t half) {
    const __m256 to_box = squared_length(beyond(_mm256_load_ps(own.x.data() + half), other.low[0], other.high[0]),
                                         beyond(_mm256_load_ps(own.y.data() + half), other.low[1], other.high[1]),
                                         beyond(_mm256_load_ps(own.z.data() + half), other.low[2], other.high[2]));
    return at_most(to_box, _mm256_load_ps(lists.reach.data() + half));
}

SPLICE_WIDE __m256 distances(const PointBlock& own, std::size_t q, const PointBlock& other, std::size_t half) {
    return squared_length(_mm256_sub_ps(_mm256_load_ps(other.x.data() + half), _mm256_set1_ps(own.x[q])),
                          _mm256_sub_ps(_mm256_load_ps(other.y.data() + half), _mm256_set1_ps(own.y[q])),
                          _mm256_sub_ps(_mm256_load_ps(other.z.data() + half), _mm256_set1_ps(own.z[q])));
}

// One vector of a sorted list after `found` was inserted; `before` is the entry in front of each.
SPLICE_WIDE __m256d inserted(__m256d list, __m256d before, __m256d found) {
    return _mm256_max_pd(before, _mm256_min_pd(list, found));
}

// The last entry of `before` and all but the last of `list`.
SPLICE_WIDE __m256d shifted(__m256d list, __m256d before) {
    return _mm256_shuffle_pd(_mm256_permute2f128_pd(before, list, 0x21), list, 0x5);
}

// The bits of distance above those of index, of eight points.
SPLICE_WIDE void store_neighbours(Neighbour* to, __m256 squared, __m256i first_indices) {
    const __m256i bits = _mm256_castps_si256(squared);
    const __m256i low = _mm256_slli_epi64(_mm256_cvtepu32_epi64(_mm256_castsi256_si128(bits)), 32),
                  high = _mm256_slli_epi64(_mm256_cvtepu32_epi64(_mm256_extracti128_si256(bits, 1)), 32);
    _mm256_store_pd(to, _mm256_castsi256_pd(_mm256_or_si256(low, first_indices)));
    const __m256i last_indices = _mm256_add_epi64(first_indices, _mm256_set1_epi64x(kLanes));
    _mm256_store_pd(to + kLanes, _mm256_castsi256_pd(_mm256_or_si256(high, last_indices)));
}

// A list of 16, which stays in registers.
SPLICE_WIDE void insert_into_16(Neighbour* list, const Neighbour* found, unsigned hits) {
    __m256d a = _mm256_load_pd(list), b = _mm256_load_pd(list + kLanes), c = _mm256_load_pd(list + 2 * kLanes),
            d = _mm256_load_pd(list + 3 * kLanes);
    for (; hits != 0; hits &= hits - 1) {
        const __m256d next = _mm256_broadcast_sd(found + std::countr_zero(hits));
        d = inserted(d, shifted(d, c), next);
        c = inserted(c, shifted(c, b), next);
        b = inserted(b, shifted(b, a), next);
        a = inserted(a, shifted(a, _mm256_setzero_pd()), next);
    }
    _mm256_store_pd(list, a);
    _mm256_store_pd(list + kLanes, b);
    _mm256_store_pd(list + 2 * kLanes, c);
    _mm256_store_pd(list + 3 * kLanes, d);
}

SPLICE_WIDE void insert_into(Neighbour* list, std::size_t stride, const Neighbour* found, unsigned hits) {
    for (; hits != 0; hits &= hits - 1) {
        const __m256d next = _mm256_broadcast_sd(found + std::countr_zero(hits));
        __m256d before = _mm256_setzero_pd();
        for (std::size_t place = 0; place < stride; place += kLanes) {
            const __m256d part = _mm256_load_pd(list + place);
            _mm256_store_pd(list + place, inserted(part, shifted(part, before), next));
            before = part;
        }
    }
}

}  // namespace

__attribute__((target("avx2"))) void add_near_points_avx2(const PointBlock& own, const PointBlock& other,
                                                          std::uint32_t first_index, bool same, NearLists& lists) {
    constexpr std::size_t kHalf = kBlockPoints / 2;
    unsigned near = near_box(own, other, lists, 0) | near_box(own, other, lists, kHalf) << kHalf;
    const __m256i first_indices = _mm256_add_epi64(_mm256_set1_epi64x(first_index), _mm256_set_epi64x(3, 2, 1, 0)),
                  last_indices = _mm256_add_epi64(first_indices, _mm256_set1_epi64x(kHalf));
    for (; near != 0; near &= near - 1) {
        const auto q = static_cast<std::size_t>(std::countr_zero(near));
        const __m256 low = distances(own, q, other, 0), high = distances(own, q, other, kHalf),
                     reach = _mm256_set1_ps(lists.reach[q]);
        unsigned hits = at_most(low, reach) | at_most(high, reach) << kHalf;
        if (same) hits &= ~(1u << q);
        if (hits == 0) continue;
        alignas(64) std::array<Neighbour, kBlockPoints> found;
        store_neighbours(found.data(), low, first_indices);
        store_neighbours(found.data() + kHalf, high, last_indices);
        Neighbour* list = lists.first + q * lists.stride;
        if (lists.stride == kBlockPoints) {
            insert_into_16(list, found.data(), hits);
        } else {
            insert_into(list, lists.stride, found.data(), hits);
        }
        update_reach(lists, q);
    }
}

}  // namespace splice

#endif
