// Declaration -> plan. A pure function: no device, no state, chance only from a seed; equal input gives equal output.
#pragma once

#include "engine/render_graph/graph.h"
#include "engine/render_graph/plan.h"

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace splice::graph {

/// What the device says of a resource; only the executor knows it.
struct MemoryRequirement {
    uint64_t size = 0;       ///< bytes; 0: not to be placed, the resource gets memory of its own
    uint64_t alignment = 1;  ///< bytes, a power of two
    uint32_t memory_type_bits = 0;
};

struct CompileOptions {
    /// Limits of the device (defaults: what Vulkan guarantees, with lavapipe's and common GPUs' 8 colour attachments).
    uint32_t max_colour_attachments = 8;
    uint32_t max_input_attachments = 4;
    // Switches, each of which changes cost and never the image.
    bool cull = true;
    bool merge = true;
    bool alias = true;  ///< transients that never live together may share memory
    /// True: one barrier before each group, for all readers of a layout together. False: one barrier, and one command,
    /// for each use that needs ordering.
    bool batch_barriers = true;
    /// A seed: any valid order, drawn evenly among what could come next. Empty: the order of declaration, as near as
    /// merging leaves it.
    std::optional<uint64_t> random_order = {};
    /// Called once for each transient resource that the plan uses, its usage flags filled in. Empty: nothing is placed.
    std::function<MemoryRequirement(uint32_t resource, const PlannedResource& planned)> memory = {};
};

/// What one compilation took, phase by phase in the order of execution; for benchmarks.
struct CompileTimings {
    struct Phase {
        const char* name = "";  ///< "validate", "cull", ...
        uint64_t nanoseconds = 0;
    };
    std::vector<Phase> phases;
    uint64_t total_nanoseconds() const;
};

/// Throws GraphError for what a single declaration call cannot see: attachments of different size or sample count in
/// one pass, more attachments than the limits allow.
/// `timings`, where given, is overwritten; the plan does not depend on it.
Plan compile(const Graph& graph, const CompileOptions& options = {}, CompileTimings* timings = nullptr);

/// One sentence each, with the names of passes and resources.
std::string explain(const Graph& graph, const CulledPass& culled);
std::string explain(const Graph& graph, const Unmerged& unmerged);

}  // namespace splice::graph
