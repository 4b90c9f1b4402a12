#include "engine/bench/graph/memory_model.h"

#include <algorithm>
#include <utility>

namespace splice::bench {
namespace {

constexpr uint64_t kSmallPage = uint64_t{4} << 10, kLargePage = uint64_t{64} << 10;

uint64_t texel_bytes(VkFormat format) {
    switch (format) {
        case VK_FORMAT_R8_UNORM:
            return 1;
        case VK_FORMAT_D16_UNORM:
            return 2;
        case VK_FORMAT_R16G16B16A16_SFLOAT:
        case VK_FORMAT_D32_SFLOAT_S8_UINT:
            return 8;
        case VK_FORMAT_R32G32B32A32_SFLOAT:
            return 16;
        default:
            return 4;
    }
}

graph::MemoryRequirement requirement(const graph::ResourceDeclaration& resource) {
    const graph::ImageDescription& image = resource.image;
    const uint64_t bytes = resource.kind == graph::ResourceKind::buffer
                               ? resource.buffer.size
                               : texel_bytes(image.format) * image.width * image.height * image.layers;
    const uint64_t page = bytes < kLargePage ? kSmallPage : kLargePage;
    return {.size = (bytes + page - 1) / page * page, .alignment = page, .memory_type_bits = 1};
}

}  // namespace

std::vector<graph::MemoryRequirement> memory_requirements(const graph::Declaration& declaration) {
    std::vector<graph::MemoryRequirement> requirements;
    requirements.reserve(declaration.resources.size());
    for (const graph::ResourceDeclaration& resource : declaration.resources)
        requirements.push_back(requirement(resource));
    return requirements;
}

uint64_t peak_live_bytes(std::span<const LiveBytes> resources) {
    std::vector<std::pair<uint64_t, const LiveBytes*>> begins, ends;  // by group
    for (const LiveBytes& resource : resources) {
        begins.emplace_back(resource.first_group, &resource);
        ends.emplace_back(uint64_t{resource.last_group} + 1, &resource);
    }
    const auto by_group = [](const auto& a, const auto& b) { return a.first < b.first; };
    std::sort(begins.begin(), begins.end(), by_group);
    std::sort(ends.begin(), ends.end(), by_group);
    uint64_t live = 0, peak = 0;
    auto end = ends.begin();
    for (const auto& [group, resource] : begins) {
        for (; end != ends.end() && end->first <= group; ++end)
            live -= end->second->bytes;
        live += resource->bytes;
        peak = std::max(peak, live);
    }
    return peak;
}

MemoryFigures memory_use(const graph::Declaration& declaration, const graph::Plan& plan,
                         std::span<const graph::MemoryRequirement> requirements) {
    MemoryFigures use;
    for (const graph::Heap& heap : plan.heaps)
        use.placed += heap.size;
    for (const graph::ResourceKind kind : {graph::ResourceKind::image, graph::ResourceKind::buffer}) {
        std::vector<LiveBytes> live;
        for (size_t resource = 0; resource < plan.resources.size(); ++resource) {
            const graph::PlannedResource& planned = plan.resources[resource];
            if (planned.heap == graph::none || declaration.resources[resource].kind != kind) continue;
            live.push_back({planned.lifetime.first_group, planned.lifetime.last_group, requirements[resource].size});
            use.unaliased += requirements[resource].size;
        }
        use.lower_bound += peak_live_bytes(live);
    }
    return use;
}

}  // namespace splice::bench
