// The inner loop of the search for nearest neighbours: the points of one block against those of another. With 512-bit
// or 256-bit vectors where the processor has them (AVX-512F, AVX2); the same result without.
#pragma once

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
    std::array<float, 3> low, high;           // of its points
};

/// Of each point of a block, the `k` nearest points found so far.
struct NearLists {
    unsigned k = 0;
    std::size_t stride = 0;      // k, rounded up to kListStep
    Neighbour* first = nullptr;  // kBlockPoints times stride, each list sorted, 64-byte aligned
    /// Squared distance of each list's entry k - 1, or a bound where it has none; negative: the point is not asked for.
    alignas(64) std::array<float, kBlockPoints> reach{};
};

/// Adds to the lists of `own` what `other`, whose first point has index `first_index`, has nearer than `reach`.
/// `same`: both are one block, and no point is its own neighbour.
using AddNearPoints = void (*)(const PointBlock& own, const PointBlock& other, std::uint32_t first_index, bool same,
                               NearLists& lists);

enum class NearVectors { kNone, k256, k512 };

/// The fastest that this processor can do with vectors of at most that width.
AddNearPoints near_points_adder(NearVectors widest = NearVectors::k512);

}  // namespace splice
