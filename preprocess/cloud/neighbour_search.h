// The nearest neighbours of every point of a cloud, all at once. Points are cut into blocks; boxes over 8, 64 ...
// blocks make a tree without pointers. A block's points are searched for together, so that the walk through the tree is
// paid once and distances are computed a block at a time. Exact: the same as a comparison with all points
// (tests/cloud/test_neighbour_search.cpp compares with a kd-tree).
#pragma once

#include "preprocess/cloud/near_block.h"
#include "preprocess/mesh/indexed_mesh.h"

#include <cstdint>
#include <span>
#include <vector>

namespace splice {

class NeighbourSearch {
  public:
    static constexpr std::size_t kBlock = kBlockPoints;
    static constexpr unsigned kMostNeighbours = 256;

    /// The `k` nearest of each point of one block, nearest first, kNoNeighbour where the cloud has no more points.
    class Lists {
      public:
        static constexpr float kUnbounded = 1e28f;  // squared distance
        std::span<const Neighbour> of(std::size_t point_of_block) const {
            return {near_.first + point_of_block * near_.stride, near_.k};
        }

      private:
        friend class NeighbourSearch;
        void reset(unsigned k);

        NearLists near_;
        std::vector<Neighbour> storage_;
        float bound_ = kUnbounded;  // squared distance within which the next search's neighbours are expected
    };

    /// Any order of the points is right, but only nearby points side by side are fast, and blocks that are compact
    /// faster (unit_cloud.h). Coordinates within 1e9.
    explicit NeighbourSearch(std::span<const Vec3f> points);

    std::size_t blocks() const { return blocks_.size(); }

    /// `k` is at most kMostNeighbours. Of points [kBlock * block, kBlock * (block + 1)), but only those whose bit is
    /// set in `points`, the first one's the lowest; a point is no neighbour of its own. Thread-safe.
    void find(std::size_t block, unsigned k, Lists& lists, std::uint32_t points = 0xffff) const;

  private:
    class Query;

    NearFunctions functions_ = near_functions();
    std::size_t points_;
    std::vector<PointBlock> blocks_;
    std::vector<std::vector<BoxGroup>> levels_;  // of single blocks first, of at most kGroupBoxes boxes last
};

}  // namespace splice
