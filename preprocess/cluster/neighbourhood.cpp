// Several centres at a time, a lane each, because all centres of a block look at the same cells. Each lane adds up what
// it would alone, so the width of vectors makes no difference to the sums.
#include "preprocess/cluster/neighbourhood.h"

#include "preprocess/cluster/roughness.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>

namespace splice {
namespace {

// Functions that take vectors must be inlined: how wide ones are passed depends on the target.
#define SPLICE_INLINE __attribute__((always_inline)) inline

constexpr float kSheetCosine = 0.8660254f;  // 30 degrees

/// The spread of a set of normals in radians, 0 to sqrt 2: for small spreads their RMS angle to the mean.
float normal_spread(const Vec3f& area_weighted_sum, float area) {
    return std::sqrt(std::max(0.0f, 2 * (1 - area_weighted_sum.norm() / area)));
}

struct Vectors128 {
    using Lanes = float __attribute__((vector_size(16)));
    using Mask = std::int32_t __attribute__((vector_size(16)));
};
struct Vectors256 {
    using Lanes = float __attribute__((vector_size(32)));
    using Mask = std::int32_t __attribute__((vector_size(32)));
};

template <class Vectors>
struct LaneVector {
    typename Vectors::Lanes x{}, y{}, z{};

    SPLICE_INLINE void set(std::size_t lane, const Vec3f& v) { x[lane] = v.x(), y[lane] = v.y(), z[lane] = v.z(); }
    SPLICE_INLINE Vec3f operator[](std::size_t lane) const { return {x[lane], y[lane], z[lane]}; }
};

template <class Vectors>
SPLICE_INLINE void add_where(typename Vectors::Lanes& sum, typename Vectors::Mask mask, float value) {
    const typename Vectors::Lanes spread = typename Vectors::Lanes{} + value;
    sum += reinterpret_cast<typename Vectors::Lanes>(mask & reinterpret_cast<typename Vectors::Mask>(spread));
}

template <class Vectors>
SPLICE_INLINE void add_where(LaneVector<Vectors>& sum, typename Vectors::Mask mask, const Vec3f& v) {
    add_where<Vectors>(sum.x, mask, v.x());
    add_where<Vectors>(sum.y, mask, v.y());
    add_where<Vectors>(sum.z, mask, v.z());
}

template <class Vectors>
SPLICE_INLINE void look_around_lanes(const CellRuns& runs, std::span<const Cell> centres, Neighbourhood* out) {
    using Lanes = typename Vectors::Lanes;
    using Mask = typename Vectors::Mask;
    constexpr std::size_t kLanes = sizeof(Lanes) / sizeof(float);
    constexpr float kDisk = std::numbers::pi_v<float> * kRoughnessRadius * kRoughnessRadius;
    for (std::size_t first = 0; first < centres.size(); first += kLanes) {
        LaneVector<Vectors> position, direction, ball_sum, sheet_sum;
        Lanes ball_area{}, sheet_area{}, triangles{};
        for (std::size_t i = 0; i < kLanes; ++i) {
            const Cell& centre = centres[std::min(first + i, centres.size() - 1)];
            position.set(i, centre.position);
            direction.set(i, centre.direction);
        }
        for (const std::span<const Cell> run : runs) {
            for (const Cell& cell : run) {
                const Lanes dx = cell.position.x() - position.x, dy = cell.position.y() - position.y,
                            dz = cell.position.z() - position.z;
                const Mask near = dx * dx + (dy * dy + dz * dz) <= kRoughnessRadius * kRoughnessRadius;
                const Lanes cosine = cell.direction.x() * direction.x +
                                     (cell.direction.y() * direction.y + cell.direction.z() * direction.z);
                const Mask same_sheet = near & ~(cosine < kSheetCosine);
                add_where(ball_sum, near, cell.normal_sum);
                add_where<Vectors>(ball_area, near, cell.area);
                add_where<Vectors>(triangles, near, cell.triangles);
                add_where(sheet_sum, same_sheet, cell.normal_sum);
                add_where<Vectors>(sheet_area, same_sheet, cell.area);
            }
        }
        const std::size_t count = std::min(kLanes, centres.size() - first);
        for (std::size_t i = 0; i < count; ++i) {
            const float ball = normal_spread(ball_sum[i], ball_area[i]);
            // A cell whose normals cancel has no direction and no sheet.
            const float sheet = sheet_area[i] > 0 ? normal_spread(sheet_sum[i], sheet_area[i]) : ball;
            out[first + i] = {ball, sheet, triangles[i] * kDisk / ball_area[i]};
        }
    }
}

#if defined(__x86_64__) && defined(__GNUC__)

__attribute__((target("avx2"))) void look_around_256(const CellRuns& runs, std::span<const Cell> centres,
                                                     Neighbourhood* out) {
    look_around_lanes<Vectors256>(runs, centres, out);
}

#else

void look_around_256(const CellRuns&, std::span<const Cell>, Neighbourhood*) {}

#endif

}  // namespace

void look_around(const CellRuns& runs, std::span<const Cell> centres, Neighbourhood* out, VectorWidth widest) {
    // With few centres most lanes of the wider ones are idle.
    if (widest >= VectorWidth::k256 && centres.size() > 4 && has_256_bit_vectors())
        return look_around_256(runs, centres, out);
    look_around_lanes<Vectors128>(runs, centres, out);
}

}  // namespace splice
