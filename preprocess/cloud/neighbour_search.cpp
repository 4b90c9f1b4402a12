#include "preprocess/cloud/neighbour_search.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <bit>

namespace splice {
namespace {

constexpr float kFarAway = 1e15f;   // coordinate of what is no point; its distances are ...
constexpr float kNotFound = 1e28f;  // ... above this, and those of points below
constexpr float kNotAsked = -1;     // reach of a point whose neighbours nobody wants

float squared_distance(const Vec3f& low_a, const Vec3f& high_a, const Vec3f& low_b, const Vec3f& high_b) {
    return (low_a - high_b).cwiseMax(low_b - high_a).cwiseMax(Vec3f::Zero()).squaredNorm();
}

}  // namespace

NeighbourSearch::NeighbourSearch(std::span<const Vec3f> points) : points_(points.size()), coordinates_(blocks()) {
    levels_.emplace_back(blocks());
    tbb::parallel_for(std::size_t{0}, blocks(), [&](std::size_t b) {
        Block& block = coordinates_[b];
        block.x.fill(kFarAway);
        block.y.fill(kFarAway);
        block.z.fill(kFarAway);
        Bounds bounds{points[b * kBlock], points[b * kBlock]};
        const auto own = points.subspan(b * kBlock, std::min(kBlock, points.size() - b * kBlock));
        for (std::size_t i = 0; i < own.size(); ++i) {
            block.x[i] = own[i].x();
            block.y[i] = own[i].y();
            block.z[i] = own[i].z();
            bounds.low = bounds.low.cwiseMin(own[i]);
            bounds.high = bounds.high.cwiseMax(own[i]);
        }
        levels_[0][b] = bounds;
    });
    while (levels_.back().size() > 1) {
        const std::vector<Bounds>& below = levels_.back();
        std::vector<Bounds> level((below.size() + 1) / 2);
        for (std::size_t i = 0; i < level.size(); ++i) {
            const Bounds &a = below[2 * i], &b = below[std::min(2 * i + 1, below.size() - 1)];
            level[i] = {a.low.cwiseMin(b.low), a.high.cwiseMax(b.high)};
        }
        levels_.push_back(std::move(level));
    }
}

// The search for one block's points.
class NeighbourSearch::Query {
  public:
    Query(const NeighbourSearch& search, std::size_t block, Lists& lists, std::uint32_t points)
        : search_(search),
          own_(search.coordinates_[block]),
          bounds_(search.levels_[0][block]),
          block_(block),
          count_(std::min(kBlock, search.points_ - block * kBlock)),
          lists_(lists) {
        reach_.fill(kNotAsked);
        for (std::size_t q = 0; q < count_; ++q)
            if ((points >> q & 1) != 0) reach_[q] = kNotFound;
    }

    // The block itself, then its sibling in the tree, the sibling of both, and so on: near ones mostly come first.
    void run() {
        look_into(block_);
        std::size_t node = block_;
        for (std::size_t level = 0; level + 1 < search_.levels_.size(); ++level, node /= 2) {
            const std::size_t sibling = node ^ 1;
            if (sibling < search_.levels_[level].size()) visit(level, sibling, distance(level, sibling));
        }
    }

  private:
    float distance(std::size_t level, std::size_t node) const {
        const Bounds& other = search_.levels_[level][node];
        return squared_distance(bounds_.low, bounds_.high, other.low, other.high);
    }

    void visit(std::size_t level, std::size_t node, float squared) {
        if (squared > farthest_) return;
        if (level == 0) return look_into(node);
        --level;
        const std::size_t first = 2 * node, second = first + 1;
        const float to_first = distance(level, first);
        if (second == search_.levels_[level].size()) return visit(level, first, to_first);
        const float to_second = distance(level, second);
        if (to_second < to_first) {
            visit(level, second, to_second);
            visit(level, first, to_first);
        } else {
            visit(level, first, to_first);
            visit(level, second, to_second);
        }
    }

    void look_into(std::size_t block) {
        const Block& other = search_.coordinates_[block];
        const Bounds& box = search_.levels_[0][block];
        for (std::size_t q = 0; q < count_; ++q) {
            const Vec3f point(own_.x[q], own_.y[q], own_.z[q]);
            const float reach = reach_[q];
            if (squared_distance(point, point, box.low, box.high) > reach) continue;
            std::array<float, kBlock> squared;
            for (std::size_t i = 0; i < kBlock; ++i) {
                const float x = other.x[i] - point.x(), y = other.y[i] - point.y(), z = other.z[i] - point.z();
                squared[i] = x * x + y * y + z * z;
            }
            if (block == block_) squared[q] = std::numeric_limits<float>::infinity();
            // One bit a hit: a loop over hits alone mispredicts less than a branch a point.
            std::uint32_t hits = 0;
            for (std::size_t i = 0; i < kBlock; ++i)
                hits |= static_cast<std::uint32_t>(squared[i] <= reach) << i;
            for (; hits != 0; hits &= hits - 1) {
                const auto i = static_cast<std::size_t>(std::countr_zero(hits));
                insert(q, squared[i], block * kBlock + i);
            }
        }
        farthest_ = *std::max_element(reach_.begin(), reach_.end());
    }

    void insert(std::size_t q, float squared, std::size_t index) {
        const auto found = std::bit_cast<Neighbour>(std::uint64_t{std::bit_cast<std::uint32_t>(squared)} << 32 | index);
        const std::size_t k = lists_.k;
        Neighbour* list = lists_.neighbours.data() + q * k;
        // Into its place without a branch: an entry becomes the middle one of itself, the one before, and what was
        // found.
        std::array<Neighbour, kMostNeighbours + 1> before;
        before[0] = 0;
        std::copy_n(list, k, before.data() + 1);
        for (std::size_t place = 0; place < k; ++place) {
            const Neighbour smaller = list[place] < found ? list[place] : found;
            list[place] = before[place] > smaller ? before[place] : smaller;
        }
        if (list[k - 1] != kNoNeighbour) reach_[q] = squared_distance_of(list[k - 1]);
    }

    const NeighbourSearch& search_;
    const Block& own_;
    const Bounds& bounds_;
    std::size_t block_, count_;
    Lists& lists_;
    std::array<float, kBlock> reach_;  // squared distance of the last neighbour found
    float farthest_ = kNotFound;       // of all points
};

void NeighbourSearch::find(std::size_t block, unsigned k, Lists& lists, std::uint32_t points) const {
    lists.k = k;
    lists.neighbours.assign(kBlock * k, kNoNeighbour);
    Query(*this, block, lists, points).run();
}

}  // namespace splice
