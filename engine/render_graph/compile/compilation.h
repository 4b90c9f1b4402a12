// What the phases of compile() hand to each other. Each phase is one function in one file; compile.cpp calls them in
// order.
#pragma once

#include "engine/render_graph/compile.h"
#include "engine/render_graph/graph.h"
#include "engine/render_graph/plan.h"

#include <cstdint>
#include <span>
#include <vector>

namespace splice::graph {

/// `from` must finish before the pass that owns the edge.
struct Edge {
    uint32_t from = 0;
    uint32_t resource = none;  ///< none: both have side effects
};

/// How one group uses one resource, all of its passes together.
struct GroupUse {
    uint32_t resource = 0;
    uint32_t group = 0;
    Scope entry;  ///< what must wait for earlier groups: loads included
    Scope exit;   ///< what later groups must wait for: stores included
    VkImageLayout entry_layout = VK_IMAGE_LAYOUT_UNDEFINED, exit_layout = VK_IMAGE_LAYOUT_UNDEFINED;
    bool writes = false;          ///< by a pass, a load or a store
    bool needs_contents = false;  ///< finds something there that it reads or adds to
};

struct Compilation {
    Compilation(const Graph& graph_, const CompileOptions& options_)
        : graph(graph_), declaration(graph_.declaration()), options(options_) {}

    const Graph& graph;
    const Declaration& declaration;
    const CompileOptions& options;
    Plan plan;

    std::vector<uint8_t> kept;        // one a pass                                        cull
    std::vector<Edge> edges;          //                                                   find_dependencies
    std::vector<Range> predecessors;  // one a pass, into edges                      find_dependencies
    std::vector<uint32_t> group_of;   // one a pass; none if culled                  merge, renumbered by order
    std::vector<GroupUse> uses;       // by resource, then by group                  lifetimes
    std::vector<Range> uses_of;       // one a resource, into uses                   lifetimes
    // Whose bytes a placed resource takes over; they may be from the frame before.
    std::vector<uint32_t> occupants;      // resources                                place_in_memory
    std::vector<Range> occupants_before;  // one a resource, into occupants           place_in_memory

    std::span<const Edge> predecessors_of(uint32_t pass) const { return slice(edges, predecessors[pass]); }
    std::span<GroupUse> uses_of_resource(uint32_t resource) {
        return std::span(uses).subspan(uses_of[resource].first, uses_of[resource].count);
    }
};

// The phases, in order.
void validate(const Compilation& compilation);  // throws GraphError
void cull(Compilation& compilation);
void find_dependencies(Compilation& compilation);
void merge(Compilation& compilation);
void order(Compilation& compilation);
void find_lifetimes(Compilation& compilation);
void plan_render_passes(Compilation& compilation);
void place_in_memory(Compilation& compilation);
void plan_barriers(Compilation& compilation);

}  // namespace splice::graph
