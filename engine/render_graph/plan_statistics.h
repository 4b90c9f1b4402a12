// What a plan costs, and what it would cost without the compiler's work: the figures of a benchmark.
#pragma once

#include "engine/render_graph/graph.h"
#include "engine/render_graph/plan.h"

#include <cstdint>

namespace splice::graph {

struct PlanStatistics {
    uint32_t passes = 0;         ///< recorded
    uint32_t culled = 0;         ///< passes
    uint32_t groups = 0;         ///< render passes, and compute and transfer passes
    uint32_t merged_groups = 0;  ///< render passes of more than one subpass
    uint32_t merged_passes = 0;  ///< their subpasses
    uint64_t barriers = 0;
    uint64_t barrier_commands = 0;
    /// Barriers of a recorder that looks at one access at a time: one for each access of a recorded pass whose resource
    /// was used before in the frame or whose image must change its layout, and one for each hand-over after the frame.
    uint64_t barriers_one_per_access = 0;
    uint64_t heap_bytes = 0;       ///< of all heaps
    uint64_t unaliased_bytes = 0;  ///< sum of the placed resources
    /// No placement needs fewer: the most that is alive in one group, summed over the heaps.
    uint64_t peak_live_bytes = 0;
};

/// The plan must be of this graph.
PlanStatistics measure(const Graph& graph, const Plan& plan);

}  // namespace splice::graph
