#include "engine/render_graph/compile.h"

#include "engine/render_graph/compile/compilation.h"

#include <utility>

namespace splice::graph {

Plan compile(const Graph& graph, const CompileOptions& options) {
    Compilation compilation(graph, options);
    validate(compilation);
    cull(compilation);
    find_dependencies(compilation);
    merge(compilation);
    order(compilation);
    find_lifetimes(compilation);
    plan_render_passes(compilation);
    place_in_memory(compilation);
    plan_barriers(compilation);
    return std::move(compilation.plan);
}

}  // namespace splice::graph
