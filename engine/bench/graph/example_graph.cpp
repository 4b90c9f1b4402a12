#include "engine/bench/graph/example_graph.h"

#include "engine/bench/graph/memory_model.h"
#include "engine/render_graph/compile.h"

namespace splice::bench {
namespace {

void add_passes(ExampleGraph& example, const graph::Graph& graph, const graph::Plan& plan) {
    for (uint32_t group = 0; group < plan.groups.size(); ++group) {
        for (const uint32_t pass : slice(plan.order, plan.groups[group].passes))
            example.passes.push_back({graph.pass_name(pass), group, false});
    }
    for (const graph::CulledPass& culled : plan.culled)
        example.passes.push_back({graph.pass_name(culled.pass), 0, true});
}

/// From the writer of contents to those that read or add to them.
void add_edges(ExampleGraph& example, const graph::Graph& graph, const graph::Plan& plan) {
    std::vector<uint32_t> writers(graph.declaration().resources.size(), graph::none);
    for (uint32_t place = 0; place < plan.order.size(); ++place) {
        for (const graph::Access& access : graph.accesses(plan.order[place])) {
            const bool write = is_write(access.kind);
            const uint32_t writer = writers[access.resource];
            if (writer != graph::none && (!write || access.contents == graph::ContentsKind::keep)) {
                const bool merged = example.passes[writer].group == example.passes[place].group;
                example.edges.push_back({writer, place, graph.resource_name(access.resource), merged});
            }
            if (write) writers[access.resource] = place;
        }
    }
}

}  // namespace

ExampleGraph example_graph(const graph::Graph& graph, const std::string& family) {
    const auto requirements = memory_requirements(graph.declaration());
    graph::CompileOptions options;
    options.memory = [&](uint32_t resource, const graph::PlannedResource&) { return requirements[resource]; };
    const graph::Plan plan = graph::compile(graph, options);
    ExampleGraph example;
    example.family = family;
    example.groups = static_cast<uint32_t>(plan.groups.size());
    add_passes(example, graph, plan);
    add_edges(example, graph, plan);
    const MemoryFigures use = memory_use(graph.declaration(), plan, requirements);
    example.heap_bytes = use.placed;
    example.lower_bound = use.lower_bound;
    for (uint32_t resource = 0; resource < plan.resources.size(); ++resource) {
        const graph::PlannedResource& planned = plan.resources[resource];
        if (planned.heap == graph::none) continue;
        example.placed.push_back({graph.resource_name(resource), planned.lifetime.first_group,
                                  planned.lifetime.last_group, planned.offset, requirements[resource].size});
    }
    return example;
}

}  // namespace splice::bench
