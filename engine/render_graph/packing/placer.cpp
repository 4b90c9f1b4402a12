#include "engine/render_graph/packing/placer.h"

#include <algorithm>
#include <bit>
#include <cmath>
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
// After the first two, placements come in rounds: so many by classes of sizes, then by size, then so many repairs of
// that.
constexpr uint32_t kByClasses = 2, kRepairs = 3, kRound = kByClasses + 1 + kRepairs;

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

/// Items of a class, of about one size, are placed one after the other in an order of time, and so come to lie side by
/// side as those of slots do. Larger classes first.
double Placer::class_priority(uint32_t size_class, uint32_t rank) {
    return static_cast<double>(size_class) * 0x1p32 + static_cast<double>(rank);
}

/// Classes of a factor of about 1.4, the longest lives first: rarely far from the bound where lives are short.
void Placer::order_by_life() {
    for (Turn& turn : turns_) {
        const PackItem& item = items_[turn.item];
        const auto octave = static_cast<uint32_t>(std::bit_width(item.size));
        const auto half = octave < 2 ? 0 : static_cast<uint32_t>(item.size >> (octave - 2)) & 1;
        turn.priority = class_priority(2 * octave + half, item.last - item.first);
    }
}

/// Classes of a factor of 4, from the end of the frame backwards. Where the classes part depends on the round; on grids
/// every second choice comes within 9 % of the bound.
void Placer::order_by_end(uint32_t round) {
    constexpr double kGolden = 0.6180339887498949;  // spreads the choices evenly
    const double shift = std::exp2(2 * std::fmod(round * kGolden, 1.0));
    for (Turn& turn : turns_) {
        const PackItem& item = items_[turn.item];
        const double shifted = std::min(static_cast<double>(item.size) * shift, 0x1p63);
        const auto octave = static_cast<uint32_t>(std::bit_width(static_cast<uint64_t>(shifted)));
        turn.priority = class_priority(octave / 2, item.last);
    }
}

/// By size, which mostly suffices; in later rounds by size times 1 to 4, at random.
void Placer::order_by_size(uint32_t round) {
    std::minstd_rand random(round);
    for (Turn& turn : turns_) {
        turn.priority = static_cast<double>(items_[turn.item].size);
        if (round > 0) turn.priority *= 1 + 3 * static_cast<double>(random()) / static_cast<double>(random.max());
    }
}

void Placer::set_priorities(uint32_t placement, uint64_t bound, size_t placed) {
    if (placement == 0) return order_by_size(0);
    if (placement == 1) return order_by_life();
    const uint32_t round = (placement - 2) / kRound, step = (placement - 2) % kRound;
    if (step < kByClasses) return order_by_end(round * kByClasses + step);
    if (step == kByClasses) return order_by_size(round + 1);
    raise_priorities(bound, placed);
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
        set_priorities(i, bound, placed);
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
