// The cell by intervals instead of by cutting a polygon, as then no step depends on the one before and no branch on the
// data: on the bisector of a neighbour s, at s / 2 + t / 2 (-s_y, s_x), another neighbour r leaves
// t s x r <= |r|^2 - s . r. What all of them leave of a bisector is an edge of the cell.
//
// Compiled without contraction to fused multiply-adds.
#include "preprocess/cloud/vicinity.h"

#include <algorithm>
#include <cmath>
#include <limits>

#if defined(__x86_64__) && defined(__GNUC__)
#define SPLICE_WIDE_VICINITY 1
#endif

namespace splice {
namespace {

constexpr std::size_t kStep = Vicinity::kStep;
using Lanes = std::array<float, kStep>;

#define SPLICE_INLINE __attribute__((always_inline)) inline

SPLICE_INLINE float sum(Lanes& lanes) {
    for (std::size_t width = kStep / 2; width >= 4; width /= 2)
        for (std::size_t i = 0; i < width; ++i)
            lanes[i] += lanes[i + width];
    return (lanes[0] + lanes[2]) + (lanes[1] + lanes[3]);
}

SPLICE_INLINE float largest(Lanes& lanes) {
    for (std::size_t width = kStep / 2; width >= 4; width /= 2)
        for (std::size_t i = 0; i < width; ++i)
            lanes[i] = lanes[i] < lanes[i + width] ? lanes[i + width] : lanes[i];
    return std::max(std::max(lanes[0], lanes[2]), std::max(lanes[1], lanes[3]));
}

SPLICE_INLINE Moments moments_inline(const Vicinity& vicinity, std::size_t count) {
    alignas(64) Lanes x{}, y{}, z{}, xx{}, xy{}, xz{}, yy{}, yz{}, zz{};
    for (std::size_t begin = 0; begin < count; begin += kStep) {
        const auto rest = static_cast<int>(count - begin);
        for (std::size_t i = 0; i < kStep; ++i) {
            const bool is_in = static_cast<int>(i) < rest;
            const float a = is_in ? vicinity.x[begin + i] : 0, b = is_in ? vicinity.y[begin + i] : 0,
                        c = is_in ? vicinity.z[begin + i] : 0;
            x[i] += a;
            y[i] += b;
            z[i] += c;
            xx[i] += a * a;
            xy[i] += a * b;
            xz[i] += a * c;
            yy[i] += b * b;
            yz[i] += b * c;
            zz[i] += c * c;
        }
    }
    return {sum(x), sum(y), sum(z), sum(xx), sum(xy), sum(xz), sum(yy), sum(yz), sum(zz)};
}

SPLICE_INLINE SmallCell small_cell_inline(const Vicinity& vicinity, const CellPlane& plane, float limit) {
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    const auto& [s, t] = plane.frame;
    const Vec3f& n = plane.normal;
    const float steepest = plane.least_cosine * plane.least_cosine;
    // Sites, their squared distances and their neighbours' heights; what is no site is far away and so limits nothing.
    alignas(64) Lanes px, py, square, height, from, to, end;
    for (std::size_t i = 0; i < kStep; ++i) {
        const float x = vicinity.x[i], y = vicinity.y[i], z = vicinity.z[i];
        const float along_s = x * s[0] + y * s[1] + z * s[2], along_t = x * t[0] + y * t[1] + z * t[2];
        const float projected = along_s * along_s + along_t * along_t;
        const bool is_site = projected > steepest * (x * x + y * y + z * z);
        px[i] = is_site ? along_s : 0;
        py[i] = is_site ? along_t : 0;
        square[i] = is_site ? projected : kInfinity;
        height[i] = x * n.x() + y * n.y() + z * n.z();
        const float farthest = 4 * limit * limit / projected - 1;
        end[i] = is_site ? std::sqrt(farthest > 0 ? farthest : 0.0f) : -1;
        from[i] = -end[i];
        to[i] = end[i];
    }
    for (std::size_t other = 0; other < kStep; ++other) {
        const float x = px[other], y = py[other], r = square[other];
        for (std::size_t i = 0; i < kStep; ++i) {
            // + 0 turns -0 into 0: what lies in the site's own direction limits all of its bisector or nothing.
            const float cross = px[i] * y - py[i] * x + 0.0f, at = (r - (px[i] * x + py[i] * y)) / cross;
            const float high = cross >= 0 ? at : kInfinity, low = cross >= 0 ? -kInfinity : at;
            to[i] = high < to[i] ? high : to[i];
            from[i] = low > from[i] ? low : from[i];
        }
    }
    alignas(64) Lanes corner, above, below, edge, open;
    for (std::size_t i = 0; i < kStep; ++i) {
        // An end at the limit is no corner.
        const float first = from[i] > -end[i] ? from[i] * from[i] : -1.0f,
                    last = to[i] < end[i] ? to[i] * to[i] : -1.0f, farther = first < last ? last : first;
        const float is_edge = from[i] < to[i] ? 1.0f : 0.0f, least = first < last ? first : last;
        corner[i] = is_edge > 0 ? square[i] * (1 + farther) / 4 : 0;
        above[i] = is_edge * height[i];
        below[i] = -above[i];
        edge[i] = is_edge;
        open[i] = least < 0 ? is_edge : 0;
    }
    return {.reach = std::sqrt(largest(corner)),
            .above = std::max(largest(above), 0.0f),
            .below = std::max(largest(below), 0.0f),
            .is_bounded = largest(edge) > 0 && largest(open) == 0};
}

Moments moments(const Vicinity& vicinity, std::size_t count) {
    return moments_inline(vicinity, count);
}
SmallCell small_cell(const Vicinity& vicinity, const CellPlane& plane, float limit) {
    return small_cell_inline(vicinity, plane, limit);
}

#ifdef SPLICE_WIDE_VICINITY
__attribute__((target("avx2"))) Moments moments_avx2(const Vicinity& vicinity, std::size_t count) {
    return moments_inline(vicinity, count);
}
__attribute__((target("avx2"))) SmallCell small_cell_avx2(const Vicinity& vicinity, const CellPlane& plane,
                                                          float limit) {
    return small_cell_inline(vicinity, plane, limit);
}
#endif

}  // namespace

VicinityFunctions vicinity_functions(bool wide) {
#ifdef SPLICE_WIDE_VICINITY
    if (wide && __builtin_cpu_supports("avx2") != 0) return {moments_avx2, small_cell_avx2};
#endif
    static_cast<void>(wide);
    return {moments, small_cell};
}

}  // namespace splice
