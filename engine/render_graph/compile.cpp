#include "engine/render_graph/compile.h"

#include "engine/render_graph/compile/compilation.h"

#include <chrono>
#include <utility>

namespace splice::graph {
namespace {

struct Phase {
    const char* name;
    void (*run)(Compilation&);
};

constexpr Phase kPhases[] = {
    {"validate", validate},
    {"cull", cull},
    {"dependencies", find_dependencies},
    {"merge", merge},
    {"order", order},
    {"lifetimes", find_lifetimes},
    {"render passes", plan_render_passes},
    {"memory", place_in_memory},
    {"barriers", plan_barriers},
};

}  // namespace

Plan compile(const Graph& graph, const CompileOptions& options, CompileTimings* timings) {
    using Clock = std::chrono::steady_clock;
    Compilation compilation(graph, options);
    if (timings) timings->phases.clear();
    for (const Phase& phase : kPhases) {
        const Clock::time_point start = timings ? Clock::now() : Clock::time_point();
        phase.run(compilation);
        if (!timings) continue;
        const auto taken = std::chrono::duration_cast<std::chrono::nanoseconds>(Clock::now() - start);
        timings->phases.push_back({phase.name, static_cast<uint64_t>(taken.count())});
    }
    return std::move(compilation.plan);
}

uint64_t CompileTimings::total_nanoseconds() const {
    uint64_t total = 0;
    for (const Phase& phase : phases)
        total += phase.nanoseconds;
    return total;
}

}  // namespace splice::graph
