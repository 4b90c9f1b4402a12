#include "engine/render_graph/packing/placer.h"

#include <algorithm>
#include <iterator>
#include <random>

namespace splice::graph {
namespace {

// Placing is repeated while the heap is larger than the bound by more than a part of it: the worse the heap, the
// longer, counted in items placed, in all and for each item of the frame.
struct Effort {
    double excess;
    size_t placed_items, times_each;
};
constexpr Effort kEfforts[] = {{0.065, 1500, 4}, {0.08, 8000, 20}, {0.09, 160000, 60}};
constexpr uint32_t kPlacements = 600;
// Of the placements, so many go on from one first order.
constexpr uint32_t kRepairs = 4;

}  // namespace

/// Gives up at the first item that reaches the limit. Returns how many were placed, that one included.
size_t Placer::place_all(std::vector<Turn>& turns, uint64_t limit) {
    std::sort(turns.begin(), turns.end(), [](const Turn& a, const Turn& b) {
        return a.priority != b.priority ? a.priority > b.priority : a.item < b.item;
    });
    size_t placed = 0;
    for (Turn& turn : turns) {
        turn.offset = index_.lowest_free(items_[turn.item]);
        index_.add(turn.item, turn.offset);
        ++placed;
        if (index_.height() >= limit) break;
    }
    return placed;
}

/// By size; in later starts by size times 1 to 4, at random.
void Placer::set_priorities(uint32_t start) {
    std::minstd_rand random(start);
    for (Turn& turn : turns_) {
        turn.priority = static_cast<double>(items_[turn.item].size);
        if (start > 0) turn.priority *= 1 + 3 * static_cast<double>(random()) / static_cast<double>(random.max());
    }
}

/// Of the items that stick out.
void Placer::raise_priorities(uint64_t bound, size_t placed) {
    const auto good = static_cast<uint64_t>(static_cast<double>(bound) * (1 + kEfforts[0].excess));
    for (size_t i = 0; i < placed; ++i) {
        if (turns_[i].offset + items_[turns_[i].item].size > good) turns_[i].priority *= 2.5;
    }
}

bool Placer::worth_another(uint64_t best, uint64_t bound, size_t placed) const {
    if (placed == 0) return true;
    const double excess = static_cast<double>(best) / static_cast<double>(bound) - 1;
    return std::any_of(std::begin(kEfforts), std::end(kEfforts), [&](const Effort& effort) {
        return excess > effort.excess && placed < std::min(effort.placed_items, effort.times_each * turns_.size());
    });
}

uint64_t Placer::place(std::vector<uint32_t> items, uint64_t bound) {
    turns_.reserve(items.size());
    for (const uint32_t item : items)
        turns_.push_back({0, item, 0});
    uint64_t best = UINT64_MAX;
    size_t placed = 0, total = 0;
    for (uint32_t i = 0; i < kPlacements && worth_another(best, bound, total); ++i) {
        if (i % kRepairs == 0) {
            set_priorities(i / kRepairs);
        } else {
            raise_priorities(bound, placed);
        }
        index_.clear();
        placed = place_all(turns_, best);
        total += placed;
        if (index_.height() >= best) continue;
        best = index_.height();
        best_ = turns_;
    }
    if (index_.height() != best) {
        index_.clear();
        for (const Turn& turn : best_)
            index_.add(turn.item, turn.offset);
    }
    return best;
}

uint64_t Placer::add(std::vector<uint32_t> items) {
    std::vector<Turn> turns;
    turns.reserve(items.size());
    for (const uint32_t item : items)
        turns.push_back({static_cast<double>(items_[item].size), item, 0});
    place_all(turns, UINT64_MAX);
    best_.insert(best_.end(), turns.begin(), turns.end());
    return index_.height();
}

void Placer::write_offsets(std::span<PackItem> items) const {
    for (const Turn& turn : best_)
        items[turn.item].offset = turn.offset;
}

}  // namespace splice::graph
