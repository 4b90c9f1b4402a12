// Offset packing: where in a heap each resource lies, so that those alive together share no byte and the heap is small.
// Knows nothing of graphs or Vulkan.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace splice::graph {

struct PackItem {
    uint32_t first = 0, last = 0;  ///< moments of its life, both inclusive
    uint64_t size = 0;             ///< bytes, at least 1
    uint64_t alignment = 1;        ///< bytes, a power of two
    // The result:
    uint64_t offset = 0;         ///< bytes
    uint32_t slot = UINT32_MAX;  ///< items of one slot have the same offset, and share bytes with each other alone
};

/// Fills in the offsets and returns the size of the heap in bytes. `moments`: more than the last of any item.
///
/// Three ideas, each of which is near-linear.
/// - Small items go into slots of one size a class of sizes, given out like the registers of a compiler: optimal for
///   items of one size (interval graphs are perfect), and what other sizes waste is known before the slots are chosen.
///   So as many of the smallest classes are slotted as cost a few percent of the bound below.
/// - Large items, few but most of the bytes, are placed largest first, each at the lowest offset that is free for its
///   whole life. An index over time finds those that live with it.
/// - Where that leaves the heap too far above the largest sum alive at one moment, below which no packing gets, the
///   items that stick out are moved forwards in the order and all are placed anew, a few times (squeaky wheel
///   optimisation; Joslin and Clements 1999), then again from another first order.
uint64_t pack(std::span<PackItem> items, uint32_t moments);

constexpr uint64_t align_up(uint64_t value, uint64_t alignment) {
    return (value + alignment - 1) & ~(alignment - 1);
}

}  // namespace splice::graph
