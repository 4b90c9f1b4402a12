// Places items one after the other, each at the lowest offset that is free for its whole life, in better and better
// orders.
#pragma once

#include "engine/render_graph/packing/lifetime_index.h"
#include "engine/render_graph/packing/pack.h"

#include <cstdint>
#include <span>
#include <vector>

namespace splice::graph {

class Placer {
  public:
    Placer(std::span<const PackItem> items, uint32_t moments) : items_(items), index_(items, moments) {}

    /// Places these items, several times while the height is far above `bound`, and returns the least height found.
    /// The index holds that placement.
    uint64_t place(std::vector<uint32_t> items, uint64_t bound);
    /// Places these, the largest first, between and above those placed before, and returns the height of all.
    uint64_t add(std::vector<uint32_t> items);
    /// Writes the offsets of what place() and add() placed.
    void write_offsets(std::span<PackItem> items) const;

  private:
    /// When an item is placed, and what came of it.
    struct Turn {
        double priority;
        uint32_t item;
        uint64_t offset;
    };
    size_t place_all(std::vector<Turn>& turns, uint64_t limit);
    static double class_priority(uint32_t size_class, uint32_t rank);
    void order_by_life();
    void order_by_end(uint32_t round);
    void order_by_size(uint32_t round);
    void set_priorities(uint32_t placement, uint64_t bound, size_t placed);
    void raise_priorities(uint64_t bound, size_t placed);
    bool worth_another(uint64_t best, uint64_t bound, size_t placed) const;

    std::span<const PackItem> items_;
    LifetimeIndex index_;
    std::vector<Turn> turns_, best_;
};

}  // namespace splice::graph
