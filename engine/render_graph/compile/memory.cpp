// Aliasing: transient resources whose lifetimes do not meet may occupy the same bytes. Greedy by size, which packs
// close to the bound of the largest sum alive at once: each resource goes to the lowest offset that is free for its
// whole life.
#include "engine/render_graph/compile/compilation.h"

#include <algorithm>
#include <iterator>
#include <map>
#include <utility>

namespace splice::graph {
namespace {

struct Item {
    uint32_t resource;
    uint32_t heap;
    Lifetime lifetime;
    uint64_t size, alignment;
    uint64_t offset;
};

bool live_together(const Lifetime& a, const Lifetime& b) {
    return a.first_group <= b.last_group && b.first_group <= a.last_group;
}

uint32_t heap_for(std::vector<Heap>& heaps, bool images, uint32_t memory_type_bits) {
    const auto found = std::find_if(heaps.begin(), heaps.end(), [&](const Heap& heap) {
        return heap.images == images && heap.memory_type_bits == memory_type_bits;
    });
    if (found != heaps.end()) return static_cast<uint32_t>(found - heaps.begin());
    heaps.push_back({0, 1, memory_type_bits, images});
    return static_cast<uint32_t>(heaps.size() - 1);
}

/// `placed` holds the items of the same heap, by offset.
uint64_t lowest_free_offset(const std::vector<Item>& placed, const Item& item, bool alias) {
    uint64_t offset = 0;
    for (const Item& other : placed) {
        if (alias && !live_together(other.lifetime, item.lifetime)) continue;
        if (offset + item.size <= other.offset) break;
        const uint64_t end = other.offset + other.size;
        offset = std::max(offset, (end + item.alignment - 1) & ~(item.alignment - 1));
    }
    return offset;
}

/// Who holds which bytes of a heap.
class Occupation {
  public:
    /// Gives [begin, end) to a resource and calls `before(other)` for each that had some of it, maybe repeatedly.
    template <typename Function>
    void take(uint64_t begin, uint64_t end, uint32_t resource, const Function& before) {
        split(begin);
        split(end);
        auto piece = pieces_.lower_bound(begin);
        while (piece != pieces_.end() && piece->first < end) {
            if (piece->second != none) before(piece->second);
            piece = pieces_.erase(piece);
        }
        pieces_[begin] = resource;
    }

  private:
    /// Makes a piece begin at `at`.
    void split(uint64_t at) {
        const auto next = pieces_.upper_bound(at);
        const uint32_t holder = next == pieces_.begin() ? none : std::prev(next)->second;
        pieces_.emplace(at, holder);
    }
    std::map<uint64_t, uint32_t> pieces_;  // where each begins; it ends where the next begins
};

/// Plays two frames in order of first use: the first shows who holds the memory at the end of a frame.
void find_occupants(Compilation& compilation, std::vector<Item> items) {
    std::stable_sort(items.begin(), items.end(), [](const Item& a, const Item& b) {
        return a.lifetime.first_group != b.lifetime.first_group ? a.lifetime.first_group < b.lifetime.first_group
                                                                : a.resource < b.resource;
    });
    std::vector<Occupation> heaps(compilation.plan.heaps.size());
    compilation.occupants_before.assign(compilation.plan.resources.size(), {});
    for (const bool record : {false, true}) {
        for (const Item& item : items) {
            const auto first = static_cast<uint32_t>(compilation.occupants.size());
            heaps[item.heap].take(item.offset, item.offset + item.size, item.resource, [&](uint32_t other) {
                if (record) compilation.occupants.push_back(other);
            });
            compilation.occupants_before[item.resource] = {first,
                                                           static_cast<uint32_t>(compilation.occupants.size()) - first};
        }
    }
}

}  // namespace

void place_in_memory(Compilation& compilation) {
    if (!compilation.options.memory) return;
    Plan& plan = compilation.plan;
    std::vector<Item> items;
    for (uint32_t resource = 0; resource < plan.resources.size(); ++resource) {
        const ResourceDeclaration& declared = compilation.declaration.resources[resource];
        const PlannedResource& planned = plan.resources[resource];
        if (declared.imported || planned.lifetime.first_group == none) continue;
        const MemoryRequirement need = compilation.options.memory(resource, planned);
        if (need.size == 0) continue;
        const uint32_t heap = heap_for(plan.heaps, declared.kind == ResourceKind::image, need.memory_type_bits);
        plan.heaps[heap].alignment = std::max(plan.heaps[heap].alignment, need.alignment);
        items.push_back({resource, heap, planned.lifetime, need.size, std::max<uint64_t>(need.alignment, 1), 0});
    }
    std::stable_sort(items.begin(), items.end(), [](const Item& a, const Item& b) { return a.size > b.size; });
    std::vector<std::vector<Item>> placed(plan.heaps.size());
    for (Item& item : items) {
        std::vector<Item>& others = placed[item.heap];
        item.offset = lowest_free_offset(others, item, compilation.options.alias);
        others.insert(std::upper_bound(others.begin(), others.end(), item,
                                       [](const Item& a, const Item& b) { return a.offset < b.offset; }),
                      item);
        plan.resources[item.resource].heap = item.heap;
        plan.resources[item.resource].offset = item.offset;
        plan.heaps[item.heap].size = std::max(plan.heaps[item.heap].size, item.offset + item.size);
    }
    find_occupants(compilation, std::move(items));
}

}  // namespace splice::graph
