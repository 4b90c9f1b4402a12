#include "engine/render_graph/plan_statistics.h"

#include <algorithm>
#include <vector>

namespace splice::graph {
namespace {

void count_passes(const Plan& plan, PlanStatistics& statistics) {
    statistics.passes = static_cast<uint32_t>(plan.order.size());
    statistics.culled = static_cast<uint32_t>(plan.culled.size());
    statistics.groups = static_cast<uint32_t>(plan.groups.size());
    for (const Group& group : plan.groups) {
        if (group.passes.count < 2) continue;
        ++statistics.merged_groups;
        statistics.merged_passes += group.passes.count;
    }
}

void count_barriers(const Plan& plan, PlanStatistics& statistics) {
    statistics.barriers = plan.image_barriers.size() + plan.buffer_barriers.size();
    statistics.barrier_commands = plan.final_barriers.empty() ? 0 : 1;
    for (const Group& group : plan.groups)
        statistics.barrier_commands += group.barriers.empty() ? 0 : 1;
    if (!plan.batch_barriers) statistics.barrier_commands = statistics.barriers;
}

uint64_t barriers_one_per_access(const Graph& graph, const Plan& plan) {
    const Declaration& declaration = graph.declaration();
    uint64_t barriers = 0;
    std::vector<uint8_t> used(declaration.resources.size(), 0);
    std::vector<VkImageLayout> layouts(declaration.resources.size(), VK_IMAGE_LAYOUT_UNDEFINED);
    for (size_t resource = 0; resource < layouts.size(); ++resource) {
        if (declaration.resources[resource].imported)
            layouts[resource] = declaration.import_of(static_cast<uint32_t>(resource)).before.layout;
    }
    for (const uint32_t pass : plan.order) {
        for (const Access& access : graph.accesses(pass)) {
            const VkImageLayout layout = layout_of(access.kind, declaration.resources[access.resource].image.format);
            barriers += used[access.resource] || layouts[access.resource] != layout ? 1 : 0;
            used[access.resource] = 1;
            layouts[access.resource] = layout;
        }
    }
    return barriers + plan.final_barriers.images.count + plan.final_barriers.buffers.count;
}

void sum_memory(const Plan& plan, PlanStatistics& statistics) {
    std::vector<int64_t> change;  // of the bytes alive, as each group begins
    for (uint32_t heap = 0; heap < plan.heaps.size(); ++heap) {
        statistics.heap_bytes += plan.heaps[heap].size;
        change.assign(plan.groups.size() + 1, 0);
        for (const PlannedResource& resource : plan.resources) {
            if (resource.heap != heap) continue;
            statistics.unaliased_bytes += resource.size;
            change[resource.lifetime.first_group] += static_cast<int64_t>(resource.size);
            change[resource.lifetime.last_group + 1] -= static_cast<int64_t>(resource.size);
        }
        int64_t alive = 0, peak = 0;
        for (const int64_t step : change) {
            alive += step;
            peak = std::max(peak, alive);
        }
        statistics.peak_live_bytes += static_cast<uint64_t>(peak);
    }
}

}  // namespace

PlanStatistics measure(const Graph& graph, const Plan& plan) {
    PlanStatistics statistics;
    count_passes(plan, statistics);
    count_barriers(plan, statistics);
    statistics.barriers_one_per_access = barriers_one_per_access(graph, plan);
    sum_memory(plan, statistics);
    return statistics;
}

}  // namespace splice::graph
