// Everything that `splice-bench graph` finds out, as plain data; report_json, report_text and report_html show it.
#pragma once

#include "engine/bench/graph/memory_model.h"
#include "engine/bench/report/sample.h"
#include "engine/render_graph/plan_statistics.h"

#include <cstdint>
#include <string>
#include <vector>

namespace splice::bench {

struct PhaseTime {
    std::string name;
    Sample ns;
};

/// One graph compiled many times, without a device.
struct CompileResult {
    std::string family;
    uint32_t passes = 0, resources = 0, accesses = 0;  ///< as declared
    graph::PlanStatistics plan;
    Sample declare_ns;    ///< the whole graph anew, names formatted, storage kept from the time before
    Sample compile_ns;    ///< compile(), all phases, the plan not destroyed
    Sample cache_hit_ns;  ///< finding that a graph equals one compiled before
    std::vector<PhaseTime> phases;
};

struct Growth {
    std::string family;
    uint32_t from = 0, to = 0;  ///< passes
    double exponent = 0;        ///< of compile time
};

/// One graph placed once a seed; bytes.
struct MemoryResult {
    std::string family;
    uint32_t passes = 0;
    MemoryFigures use;       ///< with the first seed
    double worst_ratio = 0;  ///< placed / lower bound, of all seeds
    uint64_t worst_seed = 0;
};

/// One graph on a device under one set of switches.
struct VariantResult {
    std::string name;
    Sample frame_ms;   ///< record, submit and wait
    Sample record_us;  ///< Executor::execute() alone
    uint32_t render_passes = 0, barrier_commands = 0, barriers = 0;
    uint64_t transient_bytes = 0;
    bool same_image = false;  ///< the same bytes as the first variant
};
struct DeviceResult {
    std::string family;
    uint32_t passes = 0, width = 0, height = 0;
    double first_frame_ms = 0;  ///< compile, Vulkan objects, pipelines, record and execute: with all switches on
    std::vector<VariantResult> variants;
};

/// The deferred view recorded through the graph and by hand.
struct RecordResult {
    uint32_t passes = 0, objects = 0, commands = 0;  ///< draws a geometry pass; Vulkan commands in all, by hand
    Sample by_hand_us, through_graph_us, declared_anew_us;
    double overhead = 0;                ///< median of graph / by hand - 1, pair by pair
    double overhead_declared_anew = 0;  ///< the same with the declaration
    bool same_commands = false;         ///< render passes, subpasses and barriers counted
    bool same_image = false;
};

/// How recording grows with a graph whose passes record nothing of their own: what the graph itself adds.
struct RecordGrowthResult {
    std::string family;
    uint32_t passes = 0, render_passes = 0, barriers = 0;
    Sample record_us;  ///< Executor::execute() of a graph that stays
    Sample hit_us;     ///< Executor::prepare() of a graph declared anew, its plan known
};

/// What the lifetime chart shows.
struct PlacedResource {
    std::string name;
    uint32_t first_group = 0, last_group = 0;
    uint64_t offset = 0, size = 0;
};
/// What the drawing of a graph shows.
struct DrawnPass {
    std::string name;
    uint32_t group = 0;
    bool culled = false;
};
struct DrawnEdge {
    uint32_t from = 0, to = 0;  ///< into ExampleGraph::passes
    std::string resource;
    bool merged = false;  ///< both in one render pass
};
struct ExampleGraph {
    std::string family;
    uint32_t groups = 0;
    uint64_t heap_bytes = 0, lower_bound = 0;
    std::vector<PlacedResource> placed;  ///< images
    std::vector<DrawnPass> passes;       ///< in recorded order; culled ones last
    std::vector<DrawnEdge> edges;
};

struct GraphReport {
    uint64_t seed = 0;
    uint32_t repeat = 0;
    std::string processor, device;  ///< device empty: none used
    std::vector<CompileResult> compiled;
    std::vector<Growth> growth;
    std::vector<MemoryResult> memory;
    std::vector<DeviceResult> on_device;
    std::vector<RecordResult> recorded;
    std::vector<RecordGrowthResult> record_growth;
    std::vector<ExampleGraph> examples;
};

}  // namespace splice::bench
