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

constexpr Box3 kNothing{{kFarAway, kFarAway, kFarAway}, {-kFarAway, -kFarAway, -kFarAway}};

void include(Box3& box, const Box3& other) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
        box.low[axis] = std::min(box.low[axis], other.low[axis]);
        box.high[axis] = std::max(box.high[axis], other.high[axis]);
    }
}

void include(Box3& box, float x, float y, float z) {
    include(box, Box3{{x, y, z}, {x, y, z}});
}

BoxGroup no_boxes() {
    BoxGroup group;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        group.low[axis].fill(kFarAway);
        group.high[axis].fill(kFarAway);
    }
    return group;
}

void put(BoxGroup& group, std::size_t i, const Box3& box) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
        group.low[axis][i] = box.low[axis];
        group.high[axis][i] = box.high[axis];
    }
}

}  // namespace

NeighbourSearch::NeighbourSearch(std::span<const Vec3f> points)
    : points_(points.size()), blocks_(large_vector<PointBlock>((points.size() + kBlock - 1) / kBlock)) {
    // One group of boxes a step, and with it the box one level up.
    std::size_t count = blocks();
    std::vector<Box3> boxes, above;
    const auto add_level = [&](const auto& box_of) {
        const std::size_t groups = (count + kGroupBoxes - 1) / kGroupBoxes;
        std::vector<BoxGroup> level(groups);
        above.assign(groups, kNothing);
        tbb::parallel_for(std::size_t{0}, groups, [&](std::size_t g) {
            level[g] = no_boxes();
            for (std::size_t i = 0; i < std::min(kGroupBoxes, count - g * kGroupBoxes); ++i) {
                const Box3 box = box_of(g * kGroupBoxes + i);
                put(level[g], i, box);
                include(above[g], box);
            }
        });
        levels_.push_back(std::move(level));
        std::swap(boxes, above);
        count = groups;
    };
    add_level([&](std::size_t b) {
        PointBlock& block = blocks_[b];
        block.x.fill(kFarAway);
        block.y.fill(kFarAway);
        block.z.fill(kFarAway);
        Box3 box = kNothing;
        const auto own = points.subspan(b * kBlock, std::min(kBlock, points.size() - b * kBlock));
        for (std::size_t i = 0; i < own.size(); ++i) {
            block.x[i] = own[i].x();
            block.y[i] = own[i].y();
            block.z[i] = own[i].z();
            include(box, own[i].x(), own[i].y(), own[i].z());
        }
        return box;
    });
    while (count > 1)
        add_level([&](std::size_t i) { return boxes[i]; });
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

// The search for some of one block's points.
class NeighbourSearch::Query {
  public:
    /// Neighbours at squared distances above `bound` are not looked for. Lists of `points` are empty.
    Query(const NeighbourSearch& search, std::size_t block, NearLists& lists, std::uint32_t points, float bound)
        : search_(search), own_(search.blocks_[block]), block_(block), points_(points), lists_(lists) {
        lists_.reach.fill(kNotAsked);
        for_each_point([&](std::size_t q) {
            lists_.reach[q] = bound;
            include(bounds_, own_.x[q], own_.y[q], own_.z[q]);
        });
        farthest_ = bound;
    }

    // The block's own group of boxes, then the groups beside it, then those beside the group of groups, and so on: near
    // ones mostly come first.
    void run() {
        std::size_t node = block_;
        look_into(block_, search_.levels_[0][block_ / kGroupBoxes].box(block_ % kGroupBoxes));
        for (std::size_t level = 0; level < search_.levels_.size(); ++level, node /= kGroupBoxes)
            visit(level, node / kGroupBoxes, 1u << node % kGroupBoxes);
        for_each_point([&](std::size_t q) { search_.functions_.settle(lists_, q); });
    }

  private:
    template <class Visit>
    void for_each_point(const Visit& visit) const {
        for (std::uint32_t rest = points_; rest != 0; rest &= rest - 1)
            visit(static_cast<std::size_t>(std::countr_zero(rest)));
    }

    // All boxes of a group but those of `done`.
    void visit(std::size_t level, std::size_t group, unsigned done) {
        const BoxGroup& boxes = search_.levels_[level][group];
        unsigned near = search_.functions_.near_boxes(boxes, bounds_, farthest_) & ~done;
        for (; near != 0; near &= near - 1) {
            const auto i = static_cast<std::size_t>(std::countr_zero(near));
            if (level == 0) {
                look_into(group * kGroupBoxes + i, boxes.box(i));
            } else {
                visit(level - 1, group * kGroupBoxes + i, 0);
            }
        }
    }

    void look_into(std::size_t block, const Box3& box) {
        if (search_.functions_.add(own_, search_.blocks_[block], box, static_cast<std::uint32_t>(block * kBlock),
                                   block == block_, lists_))
            farthest_ = *std::max_element(lists_.reach.begin(), lists_.reach.end());
    }

    const NeighbourSearch& search_;
    const PointBlock& own_;
    std::size_t block_;
    std::uint32_t points_;
    Box3 bounds_ = kNothing;  // of the points asked for
    NearLists& lists_;
    float farthest_;  // squared distance of the last neighbour found, of all points
};

// Blocks side by side have neighbours about as far away: beyond a bound from the block before nothing is looked for.
// Points for which it was too near are searched again with a wider one, and then with none. All bounds give the same
// lists.
void NeighbourSearch::find(std::size_t block, unsigned k, Lists& lists, std::uint32_t points) const {
    constexpr float kRoom = 1.4f, kWider = 2;
    points &= (1u << std::min(kBlock, points_ - block * kBlock)) - 1;
    lists.reset(k);
    float sum = 0, found = 0;
    for (const float bound : {lists.bound_, kWider * lists.bound_, kNotFound}) {
        Query(*this, block, lists.near_, points, std::min(bound, kNotFound)).run();
        std::uint32_t wanting = 0;
        for (std::uint32_t rest = points; rest != 0; rest &= rest - 1) {
            const auto q = static_cast<std::size_t>(std::countr_zero(rest));
            const Neighbour last = lists.of(q).back();
            if (last != kNoNeighbour) {
                sum += squared_distance_of(last);
                found += 1;
            } else if (bound < kNotFound) {
                lists.near_.clear(q);
                wanting |= 1u << q;
            }
        }
        points = wanting;
        if (points == 0) break;
    }
    lists.bound_ = found > 0 ? std::min(kRoom * sum / found, kNotFound) : kNotFound;
}

}  // namespace splice
