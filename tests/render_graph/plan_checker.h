// What can be seen of a plan without walking it: its order, lifetimes, usages, places in memory, and what its render
// passes say of attachments and subpasses. Like the hazard checker, it shares no table and no code with the compiler.
#pragma once

#include "engine/render_graph/compile.h"
#include "engine/render_graph/graph.h"
#include "engine/render_graph/plan.h"

#include <set>
#include <string>
#include <vector>

namespace splice::test {

/// Everything wrong, a sentence each. `memory`: what each resource needs where the plan placed it in a heap (empty:
/// nothing was placed).
std::vector<std::string> find_flaws(const graph::Graph& graph, const graph::Plan& plan,
                                    const std::vector<graph::MemoryRequirement>& memory);

/// Passes that are not exactly once in the order or culled, culled or reordered side effects, groups that do not tile
/// the order.
std::vector<std::string> find_disorder(const graph::Graph& graph, const graph::Plan& plan);

/// The passes that a side effect or the outside needs, by brute force over versions: what culling has to keep.
std::set<uint32_t> needed_passes(const graph::Graph& graph);

/// For each resource, those that share bytes with it.
std::vector<std::vector<uint32_t>> find_sharers(const graph::Plan& plan,
                                                const std::vector<graph::MemoryRequirement>& memory);

}  // namespace splice::test
