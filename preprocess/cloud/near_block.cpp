// Compiled without contraction to fused multiply-adds, so that every processor computes the same distances.
#include "preprocess/cloud/near_block.h"

#include <algorithm>

#if defined(__x86_64__) && defined(__GNUC__)
#define SPLICE_WIDE_BLOCKS 1
#include <immintrin.h>
#endif

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

void update_reach(NearLists& lists, std::size_t q) {
    const Neighbour last = lists.first[q * lists.stride + lists.k - 1];
    if (last != kNoNeighbour) lists.reach[q] = squared_distance_of(last);
}

}  // namespace

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

#ifdef SPLICE_WIDE_BLOCKS

namespace {

constexpr std::size_t kLanes = 8;  // doubles in a vector
static_assert(kListStep == kLanes && kBlockPoints == 2 * kLanes);

#define SPLICE_WIDE __attribute__((target("avx512f"), always_inline)) inline

SPLICE_WIDE __m512 beyond(__m512 value, float low, float high) {
    const __m512 farther =
        _mm512_max_ps(_mm512_sub_ps(_mm512_set1_ps(low), value), _mm512_sub_ps(value, _mm512_set1_ps(high)));
    return _mm512_max_ps(farther, _mm512_setzero_ps());
}

SPLICE_WIDE __m512 squared_length(__m512 x, __m512 y, __m512 z) {
    return _mm512_add_ps(_mm512_add_ps(_mm512_mul_ps(x, x), _mm512_mul_ps(y, y)), _mm512_mul_ps(z, z));
}

// One vector of a sorted list after `found` was inserted; `before` is the entry in front of each.
SPLICE_WIDE __m512d inserted(__m512d list, __m512d before, __m512d found) {
    return _mm512_max_pd(before, _mm512_min_pd(list, found));
}

SPLICE_WIDE __m512d shifted(__m512d list, __m512d before) {
    return _mm512_castsi512_pd(_mm512_alignr_epi64(_mm512_castpd_si512(list), _mm512_castpd_si512(before), 7));
}

__attribute__((target("avx512f"))) void add_near_points_wide(const PointBlock& own, const PointBlock& other,
                                                             std::uint32_t first_index, bool same, NearLists& lists) {
    const __m512 own_x = _mm512_load_ps(own.x.data()), own_y = _mm512_load_ps(own.y.data()),
                 own_z = _mm512_load_ps(own.z.data());
    const __m512 to_box =
        squared_length(beyond(own_x, other.low[0], other.high[0]), beyond(own_y, other.low[1], other.high[1]),
                       beyond(own_z, other.low[2], other.high[2]));
    unsigned near = _mm512_cmp_ps_mask(to_box, _mm512_load_ps(lists.reach.data()), _CMP_LE_OQ);
    if (near == 0) return;
    const __m512 other_x = _mm512_load_ps(other.x.data()), other_y = _mm512_load_ps(other.y.data()),
                 other_z = _mm512_load_ps(other.z.data());
    const __m512i first_indices =
                      _mm512_add_epi64(_mm512_set1_epi64(first_index), _mm512_set_epi64(7, 6, 5, 4, 3, 2, 1, 0)),
                  last_indices = _mm512_add_epi64(first_indices, _mm512_set1_epi64(kLanes));
    for (; near != 0; near &= near - 1) {
        const auto q = static_cast<std::size_t>(std::countr_zero(near));
        const __m512 squared = squared_length(_mm512_sub_ps(other_x, _mm512_set1_ps(own.x[q])),
                                              _mm512_sub_ps(other_y, _mm512_set1_ps(own.y[q])),
                                              _mm512_sub_ps(other_z, _mm512_set1_ps(own.z[q])));
        unsigned hits = _mm512_cmp_ps_mask(squared, _mm512_set1_ps(lists.reach[q]), _CMP_LE_OQ);
        if (same) hits &= ~(1u << q);
        if (hits == 0) continue;
        const __m512i bits = _mm512_castps_si512(squared);
        const __m512i first_bits = _mm512_cvtepu32_epi64(_mm512_castsi512_si256(bits)),
                      last_bits = _mm512_cvtepu32_epi64(_mm512_extracti64x4_epi64(bits, 1));
        alignas(64) std::array<Neighbour, kBlockPoints> found;
        _mm512_store_si512(found.data(), _mm512_or_si512(_mm512_slli_epi64(first_bits, 32), first_indices));
        _mm512_store_si512(found.data() + kLanes, _mm512_or_si512(_mm512_slli_epi64(last_bits, 32), last_indices));
        Neighbour* list = lists.first + q * lists.stride;
        if (lists.stride == 2 * kLanes) {
            __m512d low = _mm512_load_pd(list), high = _mm512_load_pd(list + kLanes);
            for (; hits != 0; hits &= hits - 1) {
                const __m512d next = _mm512_set1_pd(found[static_cast<std::size_t>(std::countr_zero(hits))]);
                high = inserted(high, shifted(high, low), next);
                low = inserted(low, shifted(low, _mm512_setzero_pd()), next);
            }
            _mm512_store_pd(list, low);
            _mm512_store_pd(list + kLanes, high);
        } else {
            for (; hits != 0; hits &= hits - 1) {
                const __m512d next = _mm512_set1_pd(found[static_cast<std::size_t>(std::countr_zero(hits))]);
                __m512d before = _mm512_setzero_pd();
                for (std::size_t place = 0; place < lists.stride; place += kLanes) {
                    const __m512d part = _mm512_load_pd(list + place);
                    _mm512_store_pd(list + place, inserted(part, shifted(part, before), next));
                    before = part;
                }
            }
        }
        update_reach(lists, q);
    }
}

}  // namespace

void add_near_points(const PointBlock& own, const PointBlock& other, std::uint32_t first_index, bool same,
                     NearLists& lists) {
    static const bool wide = __builtin_cpu_supports("avx512f") != 0;
    if (wide) return add_near_points_wide(own, other, first_index, same, lists);
    add_near_points_plainly(own, other, first_index, same, lists);
}

#else

void add_near_points(const PointBlock& own, const PointBlock& other, std::uint32_t first_index, bool same,
                     NearLists& lists) {
    add_near_points_plainly(own, other, first_index, same, lists);
}

#endif

}  // namespace splice
