// What resources are taken to need where no device is asked, and the least that any placement needs.
#pragma once

#include "engine/render_graph/compile.h"
#include "engine/render_graph/graph.h"
#include "engine/render_graph/plan.h"

#include <cstdint>
#include <span>
#include <vector>

namespace splice::bench {

/// Width x height x layers texels, tightly packed, rounded up to pages as desktop GPUs have them: 4 KiB, or 64 KiB from
/// 64 KiB on. One entry a declared resource.
std::vector<graph::MemoryRequirement> memory_requirements(const graph::Declaration& declaration);

/// The sum of what is placed, and of all of it if nothing shares: bytes.
struct MemoryFigures {
    uint64_t placed = 0;       ///< heaps of the plan
    uint64_t unaliased = 0;    ///< every placed resource for itself
    uint64_t lower_bound = 0;  ///< no placement of these lifetimes needs less
};

/// Groups are a plan's; both ends belong to the life.
struct LiveBytes {
    uint32_t first_group = 0, last_group = 0;
    uint64_t bytes = 0;
};
/// The largest sum that is alive in one group. Written for the benchmark alone, so that the plan's own figures are
/// checked against it.
uint64_t peak_live_bytes(std::span<const LiveBytes> resources);

/// Images and buffers apart, since they never share a heap.
MemoryFigures memory_use(const graph::Declaration& declaration, const graph::Plan& plan,
                         std::span<const graph::MemoryRequirement> requirements);

}  // namespace splice::bench
