// The inner loops of the search for nearest neighbours: boxes near enough to be looked into, the points of one block
// against those of another, and what is found into sorted lists. With 256-bit vectors where the processor has them
// (AVX2); the same result without.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <limits>

namespace splice {

/// A neighbour as one number: the bits of its squared distance above those of its index, so that the nearer one, of
/// equally near ones the one of the smaller index, is the smaller number. As a double, since processors keep sorted
/// lists of those by minimum and maximum, several entries at a time.
using Neighbour = double;

/// Larger than any neighbour.
inline constexpr Neighbour kNoNeighbour = std::numeric_limits<double>::max();

inline Neighbour make_neighbour(float squared_distance, std::uint32_t index) {
    return std::bit_cast<Neighbour>(std::uint64_t{std::bit_cast<std::uint32_t>(squared_distance)} << 32 | index);
}
inline std::uint32_t index_of(Neighbour neighbour) {
    return static_cast<std::uint32_t>(std::bit_cast<std::uint64_t>(neighbour));
}
inline float squared_distance_of(Neighbour neighbour) {
    return std::bit_cast<float>(static_cast<std::uint32_t>(std::bit_cast<std::uint64_t>(neighbour) >> 32));
}

inline constexpr std::size_t kBlockPoints = 16;
/// Lists of neighbours are this much longer than asked for at most, so that they are whole vectors.
inline constexpr std::size_t kListStep = 8;

struct alignas(64) PointBlock {
    std::array<float, kBlockPoints> x, y, z;  // beyond the last point: far away
};

struct Box3 {
    std::array<float, 3> low, high;
};

inline constexpr std::size_t kGroupBoxes = 8;

struct alignas(32) BoxGroup {
    std::array<std::array<float, kGroupBoxes>, 3> low, high;  // beyond the last box: far away

    Box3 box(std::size_t i) const { return {{low[0][i], low[1][i], low[2][i]}, {high[0][i], high[1][i], high[2][i]}}; }
};

/// Of each point of a block, the `k` nearest points found so far. What is found is kept aside, unsorted, until there is
/// some of it: most of the time goes to branches that no processor foresees, and so there is one run of insertions
/// instead of one for every block.
struct NearLists {
    static constexpr std::size_t kAside = 64;

    unsigned k = 0;
    std::size_t stride = 0;      // k, rounded up to kListStep
    Neighbour* first = nullptr;  // kBlockPoints times stride, each list sorted, 64-byte aligned
    /// Squared distance of each list's entry k - 1, or a bound where it has none; negative: the point is not asked for.
    alignas(64) std::array<float, kBlockPoints> reach{};
    std::array<std::size_t, kBlockPoints> aside{};  // how many are
    alignas(64) std::array<std::array<float, kAside>, kBlockPoints> squared;
    alignas(64) std::array<std::array<std::uint32_t, kAside>, kBlockPoints> index;

    void clear(std::size_t point) { std::fill_n(first + point * stride, stride, kNoNeighbour); }
};

struct NearFunctions {
    /// One bit for each box whose squared distance from `box` is at most `farthest`.
    unsigned (*near_boxes)(const BoxGroup& group, const Box3& box, float farthest);
    /// Puts aside for the points of `own` what `other`, within `box` and with `first_index` for its first point, has
    /// nearer than `reach`. `same`: both are one block, and no point is its own neighbour. True if a reach has changed.
    bool (*add)(const PointBlock& own, const PointBlock& other, const Box3& box, std::uint32_t first_index, bool same,
                NearLists& lists);
    /// Sorts what is aside for a point into its list.
    void (*settle)(NearLists& lists, std::size_t point);
};

/// The fastest that this processor can do, or what every one can.
NearFunctions near_functions(bool wide = true);

}  // namespace splice
