// What the phases of compile() hand to each other. Each phase is one function in one file; compile.cpp calls them in
// order.
#pragma once

#include "engine/render_graph/compile.h"
#include "engine/render_graph/graph.h"
#include "engine/render_graph/plan.h"

#include <cstddef>
#include <cstdint>
#include <memory_resource>
#include <span>
#include <vector>

namespace splice::graph {

/// `from` must finish before the pass that owns the edge.
struct Edge {
    uint32_t from = 0;
    uint32_t resource = none;    ///< none: both have side effects
    bool as_attachment = false;  ///< how the pass that owns the edge uses the resource
};

/// How one group uses one resource, all of its passes together.
struct GroupUse {
    uint32_t group = 0;
    Scope entry;  ///< what must wait for earlier groups: loads included
    Scope exit;   ///< what later groups must wait for: stores included
    VkImageLayout entry_layout = VK_IMAGE_LAYOUT_UNDEFINED, exit_layout = VK_IMAGE_LAYOUT_UNDEFINED;
    bool writes = false;          ///< by a pass, a load or a store
    bool needs_contents = false;  ///< finds something there that it reads or adds to
};

struct Compilation {
    /// More than all phases use for each access, so that one piece of memory suffices.
    static constexpr size_t kScratchBytes = 512;

    Compilation(const Graph& graph_, const CompileOptions& options_)
        : graph(graph_),
          declaration(graph_.declaration()),
          options(options_),
          scratch(4096 + kScratchBytes * declaration.accesses.size()) {}

    const Graph& graph;
    const Declaration& declaration;
    const CompileOptions& options;
    Plan plan;

    /// What phases hand to each other comes from here, and all of it goes back in one piece: an allocator that returns
    /// free memory to the system would otherwise do so, and fetch it again, every compilation.
    std::pmr::monotonic_buffer_resource scratch;

    // cull
    std::pmr::vector<uint8_t> kept{&scratch};  // one a pass
    // find_dependencies
    std::pmr::vector<Edge> edges{&scratch};
    std::pmr::vector<Range> predecessors{&scratch};  // one a pass, into edges
    // merge; renumbered by order
    std::pmr::vector<uint32_t> group_of{&scratch};  // one a pass; none if culled
    // find_lifetimes
    std::pmr::vector<GroupUse> uses{&scratch};  // by resource, then by group
    std::pmr::vector<Range> uses_of{&scratch};  // one a resource, into uses
    // place_in_memory: whose bytes a placed resource takes over; they may be from the frame before
    std::pmr::vector<uint32_t> occupants{&scratch};      // resources
    std::pmr::vector<Range> occupants_before{&scratch};  // one a resource, into occupants

    std::span<const Edge> predecessors_of(uint32_t pass) const { return slice(edges, predecessors[pass]); }
    std::span<GroupUse> uses_of_resource(uint32_t resource) {
        return std::span(uses).subspan(uses_of[resource].first, uses_of[resource].count);
    }
};

// The phases, in order.
void validate(Compilation& compilation);  // throws GraphError
void cull(Compilation& compilation);
void find_dependencies(Compilation& compilation);
void merge(Compilation& compilation);
void order(Compilation& compilation);
void find_lifetimes(Compilation& compilation);
void plan_render_passes(Compilation& compilation);
void place_in_memory(Compilation& compilation);
void plan_barriers(Compilation& compilation);

}  // namespace splice::graph
