// Walks a plan as a device would execute it - two frames in a row, four where there are histories - and says what goes
// wrong. Written from the Vulkan specification's memory model, on its own: it shares no table and no code with the
// compiler.
//
// The model. Every use of a resource becomes atoms, one a pipeline stage. A barrier, or a dependency between subpasses,
// extends what happens after an atom (the stages of its second scope) if the atom, or something already ordered after
// it, is in its first scope; a write is available once its access was in the first scope, and visible to the accesses
// of the second. A read needs every earlier write ordered, available and visible; a write needs every earlier read and
// write ordered. A transition of layout is a write. Contents are followed by the pass that made them. Whatever uses
// bytes that another resource had must come after all that was done to that one, and takes its contents from it.
#pragma once

#include "engine/render_graph/compile.h"
#include "engine/render_graph/graph.h"
#include "engine/render_graph/plan.h"

#include <string>
#include <vector>

namespace splice::test {

/// Everything wrong with the plan, that of plan_checker.h included, a sentence each; empty for a correct plan.
/// `memory`: what each resource needs where the plan placed it in a heap (empty: nothing was placed).
std::vector<std::string> find_hazards(const graph::Graph& graph, const graph::Plan& plan,
                                      const std::vector<graph::MemoryRequirement>& memory = {});

}  // namespace splice::test
