#include "preprocess/cloud/compact_blocks.h"

#include <Eigen/Core>
#include <algorithm>
#include <bit>

namespace splice {
namespace {

std::size_t longest_side(std::span<const PlacedPoint> points) {
    // The fourth is the index, of which nothing comes.
    const auto four = [](const PlacedPoint& point) { return Eigen::Map<const Eigen::Array4f>(point.position.data()); };
    Eigen::Array4f low = four(points.front()), high = low;
    for (const PlacedPoint& point : points) {
        low = low.min(four(point));
        high = high.max(four(point));
    }
    Eigen::Index axis = 0;
    (high - low).head<3>().maxCoeff(&axis);
    return static_cast<std::size_t>(axis);
}

// Brings those for which it holds to the front, without a branch on the data; how many those are.
template <class Holds>
std::size_t partition(std::span<PlacedPoint> points, const Holds& holds) {
    std::size_t count = 0;
    for (PlacedPoint& point : points) {
        const PlacedPoint taken = point;
        point = points[count];
        points[count] = taken;
        count += holds(taken);
    }
    return count;
}

// std::nth_element (Hoare 1961), whose branches no processor foresees.
void select(std::span<PlacedPoint> points, std::size_t nth, std::size_t axis) {
    constexpr std::size_t kFew = 8;
    constexpr int kMostRounds = 64;  // beyond, nth_element's bound on the time counts
    for (int round = 0; points.size() > kFew && round < kMostRounds; ++round) {
        const float a = points.front().position[axis], b = points[points.size() / 2].position[axis],
                    c = points.back().position[axis];
        const float pivot = std::max(std::min(a, b), std::min(std::max(a, b), c));
        std::size_t count = partition(points, [&](const PlacedPoint& p) { return p.position[axis] < pivot; });
        if (nth < count) {
            points = points.first(count);
            continue;
        }
        // None is less where the pivot is the least: then those equal to it are set apart.
        if (count == 0) {
            count = partition(points, [&](const PlacedPoint& p) { return p.position[axis] <= pivot; });
            if (nth < count) return;
        }
        points = points.subspan(count);
        nth -= count;
    }
    std::nth_element(points.begin(), points.begin() + static_cast<std::ptrdiff_t>(nth), points.end(),
                     [&](const PlacedPoint& p, const PlacedPoint& q) { return p.position[axis] < q.position[axis]; });
}

}  // namespace

void order_by_blocks(std::span<PlacedPoint> points, std::size_t block) {
    if (points.size() <= block) return;
    // The first half has a power of two of blocks.
    const std::size_t blocks = (points.size() + block - 1) / block, half = std::bit_ceil(blocks) / 2 * block;
    select(points, half, longest_side(points));
    order_by_blocks(points.first(half), block);
    order_by_blocks(points.subspan(half), block);
}

}  // namespace splice
