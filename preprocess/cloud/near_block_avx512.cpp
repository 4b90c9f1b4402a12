// Near blocks with 512-bit vectors: a block's 16 points are one vector, a list of 16 neighbours is two.
#include "preprocess/cloud/near_block_vectors.h"

#ifdef SPLICE_NEAR_VECTORS

#include <immintrin.h>

namespace splice {
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

}  // namespace

__attribute__((target("avx512f"))) void add_near_points_avx512(const PointBlock& own, const PointBlock& other,
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

}  // namespace splice

#endif
