// The nearest neighbours of every point of a cloud, all at once. Points in Morton order are cut into blocks; boxes over
// 2, 4, 8 ... blocks make a tree without pointers. A block's points are searched for together, so that the walk through
// the tree is paid once and distances are computed a block at a time. Exact: the same as a comparison with all points,
// and about twice as fast on a scan as a kd-tree asked point by point (tests/cloud/test_neighbour_search.cpp compares
// both).
#pragma once

#include "preprocess/mesh/indexed_mesh.h"

#include <array>
#include <bit>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

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

class NeighbourSearch {
  public:
    static constexpr std::size_t kBlock = 16;
    static constexpr unsigned kMostNeighbours = 256;

    /// The `k` nearest of each point of one block, nearest first, kNoNeighbour where the cloud has no more points.
    struct Lists {
        unsigned k = 0;
        std::vector<Neighbour> neighbours;

        std::span<const Neighbour> of(std::size_t point_of_block) const {
            return std::span(neighbours).subspan(point_of_block * k, k);
        }
    };

    /// Any order of the points is right, but only nearby points side by side are fast. Coordinates within 1e9.
    explicit NeighbourSearch(std::span<const Vec3f> points);

    std::size_t blocks() const { return (points_ + kBlock - 1) / kBlock; }

    /// `k` is at most kMostNeighbours. Of points [kBlock * block, kBlock * (block + 1)), but only those whose bit is
    /// set in `points`, the first one's the lowest; a point is no neighbour of its own. Thread-safe.
    void find(std::size_t block, unsigned k, Lists& lists, std::uint32_t points = 0xffff) const;

  private:
    struct Bounds {
        Vec3f low, high;
    };
    struct Block {
        std::array<float, kBlock> x, y, z;  // beyond the last point: far away
    };
    class Query;

    std::size_t points_;
    std::vector<Block> coordinates_;
    std::vector<std::vector<Bounds>> levels_;  // of single blocks first, of all last
};

}  // namespace splice
