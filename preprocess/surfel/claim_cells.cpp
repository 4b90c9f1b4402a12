// Compiled without contraction to fused multiply-adds, so that every processor computes the same distances. Written
// without branches, so that the loops compile to vector instructions.
#include "preprocess/surfel/claim_cells.h"

namespace splice {
namespace {

__attribute__((always_inline)) inline void claim(const SiteReach reach, const float scale, const std::uint32_t site,
                                                 const CellRange cells, float* __restrict nearest,
                                                 std::uint32_t* __restrict owner) {
    const float* __restrict x = cells.x, * __restrict y = cells.y, * __restrict z = cells.z;
    for (std::uint32_t i = 0; i < cells.count; ++i) {
        float squared = 0;
        const bool covers = reach.covers(x[i], y[i], z[i], squared);
        const float scaled = squared * scale, before = nearest[i];
        const bool takes = covers & (scaled < before);
        nearest[i] = takes ? scaled : before;
        owner[i] = takes ? site : owner[i];
    }
}

__attribute__((always_inline)) inline void mark(const SiteReach reach, const CellRange cells,
                                                std::uint32_t* __restrict marks) {
    const float* __restrict x = cells.x, * __restrict y = cells.y, * __restrict z = cells.z;
    for (std::uint32_t i = 0; i < cells.count; ++i) {
        float squared = 0;
        const bool covers = reach.covers(x[i], y[i], z[i], squared);
        marks[i] = covers ? 1 : marks[i];
    }
}

#if defined(__x86_64__) && defined(__GNUC__)

__attribute__((target("avx2"))) void claim_wide(const SiteReach& reach, float scale, std::uint32_t site,
                                                const CellRange& cells, float* nearest, std::uint32_t* owner) {
    claim(reach, scale, site, cells, nearest, owner);
}

__attribute__((target("avx2"))) void mark_wide(const SiteReach& reach, const CellRange& cells, std::uint32_t* marks) {
    mark(reach, cells, marks);
}

#else

void claim_wide(const SiteReach&, float, std::uint32_t, const CellRange&, float*, std::uint32_t*) {}
void mark_wide(const SiteReach&, const CellRange&, std::uint32_t*) {}

#endif

}  // namespace

void claim_cells(const SiteReach& reach, float scale, std::uint32_t site, const CellRange& cells, float* nearest,
                 std::uint32_t* owner, VectorWidth widest) {
    if (widest >= VectorWidth::k256 && has_256_bit_vectors())
        return claim_wide(reach, scale, site, cells, nearest, owner);
    claim(reach, scale, site, cells, nearest, owner);
}

void mark_cells(const SiteReach& reach, const CellRange& cells, std::uint32_t* marks, VectorWidth widest) {
    if (widest >= VectorWidth::k256 && has_256_bit_vectors()) return mark_wide(reach, cells, marks);
    mark(reach, cells, marks);
}

}  // namespace splice
