#include "engine/render_graph/packing/pack.h"

#include "engine/render_graph/packing/placer.h"
#include "engine/render_graph/packing/slots.h"

#include <utility>
#include <vector>

namespace splice::graph {
namespace {

// Up to so many items all are placed one by one: slots save no time worth a byte.
constexpr size_t kFewItems = 96;
// Slots may cost so much more than the bound, as a part of it.
constexpr double kSlotShare = 0.03;
// Where all items in slots cost at most this much more than the bound, all are: frames of a few sizes.
constexpr double kAllSlots = 0.02;
// Where the heap with slots exceeds the bound by more than this, the small items go between the large ones instead.
constexpr double kTooMuch = 0.07;

}  // namespace

uint64_t pack(std::span<PackItem> items, uint32_t moments) {
    Slots slots(items, moments);
    if (items.size() > kFewItems) slots.choose(kSlotShare, kAllSlots);
    std::vector<uint32_t> large, small;
    for (uint32_t i = 0; i < items.size(); ++i)
        (slots.take(items[i]) ? small : large).push_back(i);
    if (large.empty()) return slots.fill(items, 0);
    Placer placer(items, moments);
    const uint64_t height = placer.place(std::move(large), slots.peak());
    placer.write_offsets(items);
    if (small.empty()) return height;
    const uint64_t slotted_height = slots.fill(items, height);
    if (static_cast<double>(slotted_height) <= static_cast<double>(slots.peak()) * (1 + kTooMuch)) {
        return slotted_height;
    }
    const std::vector<uint32_t> in_slots = small;
    const uint64_t placed_height = placer.add(std::move(small));
    if (placed_height >= slotted_height) return slotted_height;
    for (const uint32_t item : in_slots)
        items[item].slot = UINT32_MAX;
    placer.write_offsets(items);
    return placed_height;
}

}  // namespace splice::graph
