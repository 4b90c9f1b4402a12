#include "preprocess/cloud/neighbour_search.h"

#include "preprocess/large_vector.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <memory>

namespace splice {
namespace {

constexpr float kFarAway = 1e15f;  // coordinate of what is no point; its distances are ...
constexpr float kNotFound = NeighbourSearch::Lists::kUnbounded;  // ... above this, and those of points below
constexpr float kNotAsked = -1;                                  // reach of a point whose neighbours nobody wants

Eigen::Vector4f padded(const Vec3f& v) {
    return {v.x(), v.y(), v.z(), 0};
}

}  // namespace

NeighbourSearch::NeighbourSearch(std::span<const Vec3f> points)
    : points_(points.size()), blocks_(large_vector<PointBlock>(blocks())) {
    levels_.push_back(large_vector<Bounds>(blocks()));
    tbb::parallel_for(std::size_t{0}, blocks(), [&](std::size_t b) {
        PointBlock& block = blocks_[b];
        block.x.fill(kFarAway);
        block.y.fill(kFarAway);
        block.z.fill(kFarAway);
        Bounds bounds{padded(points[b * kBlock]), padded(points[b * kBlock])};
        const auto own = points.subspan(b * kBlock, std::min(kBlock, points.size() - b * kBlock));
        for (std::size_t i = 0; i < own.size(); ++i) {
            block.x[i] = own[i].x();
            block.y[i] = own[i].y();
            block.z[i] = own[i].z();
            bounds.low = bounds.low.cwiseMin(padded(own[i]));
            bounds.high = bounds.high.cwiseMax(padded(own[i]));
        }
        std::copy_n(bounds.low.data(), 3, block.low.begin());
        std::copy_n(bounds.high.data(), 3, block.high.begin());
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

void NeighbourSearch::Lists::reset(unsigned k) {
    constexpr std::size_t kAlignment = 64;
    near_.k = k;
    near_.stride = (k + kListStep - 1) / kListStep * kListStep;
    storage_.assign(kBlock * near_.stride + kAlignment / sizeof(Neighbour), kNoNeighbour);
    void* first = storage_.data();
    std::size_t room = storage_.size() * sizeof(Neighbour);
    near_.first = static_cast<Neighbour*>(std::align(kAlignment, sizeof(Neighbour), first, room));
}

// The search for one block's points.
class NeighbourSearch::Query {
  public:
    /// Neighbours at squared distances above `bound` are not looked for.
    Query(const NeighbourSearch& search, std::size_t block, NearLists& lists, std::uint32_t points, float bound)
        : search_(search), own_(search.blocks_[block]), block_(block), lists_(lists) {
        lists_.reach.fill(kNotAsked);
        for (std::size_t q = 0; q < std::min(kBlock, search.points_ - block * kBlock); ++q) {
            if ((points >> q & 1) == 0) continue;
            lists_.reach[q] = bound;
            const Eigen::Vector4f point(own_.x[q], own_.y[q], own_.z[q], 0);
            bounds_ = {bounds_.low.cwiseMin(point), bounds_.high.cwiseMax(point)};
        }
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
        return (bounds_.low - other.high)
            .cwiseMax(other.low - bounds_.high)
            .cwiseMax(Eigen::Vector4f::Zero())
            .squaredNorm();
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
        search_.add_near_points_(own_, search_.blocks_[block], static_cast<std::uint32_t>(block * kBlock),
                                 block == block_, lists_);
        farthest_ = *std::max_element(lists_.reach.begin(), lists_.reach.end());
    }

    const NeighbourSearch& search_;
    const PointBlock& own_;
    Bounds bounds_{padded(Vec3f::Constant(kFarAway)), padded(Vec3f::Constant(-kFarAway))};  // of the points asked for
    std::size_t block_;
    NearLists& lists_;
    float farthest_ = kNotFound;  // squared distance of the last neighbour found, of all points
};

// Blocks side by side have neighbours about as far away. A bound from the block before keeps most points that would
// soon be pushed out again from being inserted at all; where it was too near, the search is repeated without.
void NeighbourSearch::find(std::size_t block, unsigned k, Lists& lists, std::uint32_t points) const {
    constexpr float kRoom = 1.3f;
    const auto search = [&](float bound) {
        lists.reset(k);
        Query(*this, block, lists.near_, points, bound).run();
    };
    const auto is_short = [&](std::size_t q) {
        return lists.near_.reach[q] >= 0 && lists.of(q).back() == kNoNeighbour;
    };
    const float bound = lists.bound_;
    search(bound);
    for (std::size_t q = 0; q < kBlock && bound < kNotFound; ++q) {
        if (!is_short(q)) continue;
        search(kNotFound);
        break;
    }
    lists.bound_ = std::min(kRoom * *std::ranges::max_element(lists.near_.reach), kNotFound);
}

}  // namespace splice
