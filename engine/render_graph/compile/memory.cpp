// Aliasing: transient resources whose lifetimes do not meet may occupy the same bytes. pack.h chooses the offsets,
// occupants.h finds who had the bytes before.
#include "engine/render_graph/compile/compilation.h"
#include "engine/render_graph/compile/occupants.h"
#include "engine/render_graph/packing/pack.h"

#include <algorithm>

namespace splice::graph {
namespace {

/// The resources of one heap.
struct Tenants {
    std::vector<uint32_t> resources;
    std::vector<PackItem> items;  // one a resource
};

uint32_t heap_for(std::vector<Heap>& heaps, bool images, uint32_t memory_type_bits) {
    const auto found = std::find_if(heaps.begin(), heaps.end(), [&](const Heap& heap) {
        return heap.images == images && heap.memory_type_bits == memory_type_bits;
    });
    if (found != heaps.end()) return static_cast<uint32_t>(found - heaps.begin());
    heaps.push_back({0, 1, memory_type_bits, images});
    return static_cast<uint32_t>(heaps.size() - 1);
}

std::vector<Tenants> find_tenants(Compilation& compilation) {
    Plan& plan = compilation.plan;
    std::vector<Tenants> heaps;
    for (uint32_t resource = 0; resource < plan.resources.size(); ++resource) {
        const ResourceDeclaration& declared = compilation.declaration.resources[resource];
        PlannedResource& planned = plan.resources[resource];
        if (!declared.transient() || planned.lifetime.first_group == none) continue;
        const MemoryRequirement need = compilation.options.memory(resource, planned);
        if (need.size == 0) continue;
        const uint64_t alignment = std::max<uint64_t>(need.alignment, 1);
        planned.heap = heap_for(plan.heaps, declared.kind == ResourceKind::image, need.memory_type_bits);
        planned.size = need.size;
        plan.heaps[planned.heap].alignment = std::max(plan.heaps[planned.heap].alignment, alignment);
        heaps.resize(plan.heaps.size());
        heaps[planned.heap].resources.push_back(resource);
        heaps[planned.heap].items.push_back(
            {planned.lifetime.first_group, planned.lifetime.last_group, need.size, alignment, 0});
    }
    return heaps;
}

uint64_t place_apart(std::span<PackItem> items) {
    uint64_t end = 0;
    for (PackItem& item : items) {
        item.offset = align_up(end, item.alignment);
        end = item.offset + item.size;
    }
    return end;
}

}  // namespace

void place_in_memory(Compilation& compilation) {
    if (!compilation.options.memory) return;
    Plan& plan = compilation.plan;
    std::vector<Tenants> heaps = find_tenants(compilation);
    compilation.occupants_before.assign(plan.resources.size(), {});
    for (uint32_t heap = 0; heap < heaps.size(); ++heap) {
        const std::span<PackItem> items = heaps[heap].items;
        plan.heaps[heap].size =
            compilation.options.alias ? pack(items, static_cast<uint32_t>(plan.groups.size())) : place_apart(items);
        for (size_t i = 0; i < items.size(); ++i)
            plan.resources[heaps[heap].resources[i]].offset = items[i].offset;
        find_occupants(items, heaps[heap].resources, compilation);
    }
}

}  // namespace splice::graph
