// Slots: bytes of one size that items of similar size have in turns.
#pragma once

#include "engine/render_graph/packing/pack.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace splice::graph {

/// Decides which of the smallest items go into slots, and gives them out like the registers of a compiler: as many of a
/// class of sizes as are ever alive at once, which no other sharing among items of one size undercuts.
class Slots {
  public:
    Slots(std::span<const PackItem> items, uint32_t moments);

    /// The largest sum of sizes alive at one moment.
    uint64_t peak() const { return peak_; }
    /// Chooses the classes, from the smallest, that take no more than `share` of the peak; all, where those take at
    /// most (1 + all_share) of it.
    void choose(double share, double all_share);
    bool take(const PackItem& item) const { return class_of(item) < slotted_; }
    /// Gives the items their slots, from `base` on, and returns where those end.
    uint64_t fill(std::span<PackItem> items, uint64_t base) const;

  private:
    /// Items by the power of two below their size.
    struct SizeClass {
        uint64_t largest = 0, alignment = 1;
        uint32_t alive = 0, most_alive = 0;
        uint64_t slot() const { return align_up(largest, alignment); }
        uint64_t bytes() const { return slot() * most_alive; }
    };

    static size_t class_of(const PackItem& item);
    template <typename Die, typename Born>
    void play(std::span<const PackItem> items, const Die& die, const Born& born) const;

    std::vector<uint32_t> births_, deaths_;  // items in order of their first and of their last moment
    std::array<SizeClass, 64> classes_{};
    uint64_t peak_ = 0;
    size_t slotted_ = 0;  // classes
};

}  // namespace splice::graph
