#include "engine/render_graph/packing/slots.h"

#include <algorithm>
#include <bit>
#include <numeric>

namespace splice::graph {
namespace {

std::vector<uint32_t> sorted_by(std::span<const PackItem> items, uint32_t moments, uint32_t PackItem::*key) {
    std::vector<uint32_t> starts(size_t{moments} + 1, 0), order(items.size());
    for (const PackItem& item : items)
        ++starts[item.*key + 1];
    std::partial_sum(starts.begin(), starts.end(), starts.begin());
    for (uint32_t i = 0; i < items.size(); ++i)
        order[starts[items[i].*key]++] = i;
    return order;
}

}  // namespace

size_t Slots::class_of(const PackItem& item) {
    return static_cast<size_t>(63 - std::countl_zero(item.size | 1));
}

/// Calls die(item) and born(item) in the order of time: those whose life ended before a birth come before it.
template <typename Die, typename Born>
void Slots::play(std::span<const PackItem> items, const Die& die, const Born& born) const {
    size_t next_death = 0;
    for (const uint32_t birth : births_) {
        while (items[deaths_[next_death]].last < items[birth].first)
            die(deaths_[next_death++]);
        born(birth);
    }
}

Slots::Slots(std::span<const PackItem> items, uint32_t moments)
    : births_(sorted_by(items, moments, &PackItem::first)), deaths_(sorted_by(items, moments, &PackItem::last)) {
    uint64_t alive = 0;
    play(
        items,
        [&](uint32_t dead) {
            alive -= items[dead].size;
            --classes_[class_of(items[dead])].alive;
        },
        [&](uint32_t born) {
            const PackItem& item = items[born];
            alive += item.size;
            peak_ = std::max(peak_, alive);
            SizeClass& size_class = classes_[class_of(item)];
            size_class.largest = std::max(size_class.largest, item.size);
            size_class.alignment = std::max(size_class.alignment, item.alignment);
            size_class.most_alive = std::max(size_class.most_alive, ++size_class.alive);
        });
}

void Slots::choose(double share, double all_share) {
    uint64_t all = 0;
    for (const SizeClass& size_class : classes_)
        all += size_class.bytes();
    const auto bound = static_cast<double>(peak_);
    slotted_ = classes_.size();
    if (static_cast<double>(all) <= bound * (1 + all_share)) return;
    uint64_t bytes = 0;
    for (slotted_ = 0; static_cast<double>(bytes += classes_[slotted_].bytes()) <= bound * share;)
        ++slotted_;
}

uint64_t Slots::fill(std::span<PackItem> items, uint64_t base) const {
    std::array<uint64_t, 64> next{};       // a class: where its next slot lies that was never used
    for (size_t i = slotted_; i-- > 0;) {  // the strictest alignments first
        next[i] = base = align_up(base, classes_[i].alignment);
        base += classes_[i].bytes();
    }
    std::array<std::vector<uint32_t>, 64> free;  // a class: items that have left their slots
    uint32_t slots = 0;
    play(
        items,
        [&](uint32_t dead) {
            if (items[dead].slot != UINT32_MAX) free[class_of(items[dead])].push_back(dead);
        },
        [&](uint32_t born) {
            const size_t size_class = class_of(items[born]);
            if (size_class >= slotted_) return;
            if (free[size_class].empty()) {
                items[born].offset = next[size_class];
                items[born].slot = slots++;
                next[size_class] += classes_[size_class].slot();
            } else {
                const PackItem& before = items[free[size_class].back()];
                free[size_class].pop_back();
                items[born].offset = before.offset;
                items[born].slot = before.slot;
            }
        });
    return base;
}

}  // namespace splice::graph
