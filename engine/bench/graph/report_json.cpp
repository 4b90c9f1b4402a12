#include "engine/bench/graph/report_json.h"

#include "engine/bench/report/changes.h"

namespace splice::bench {
namespace {
using nlohmann::json;

template <typename T, typename Function>
json list(const std::vector<T>& elements, const Function& function) {
    json all = json::array();
    for (const T& element : elements)
        all.push_back(function(element));
    return all;
}

json compiled(const CompileResult& result) {
    const graph::PlanStatistics& plan = result.plan;
    return {{"family", result.family},
            {"passes", result.passes},
            {"resources", result.resources},
            {"accesses", result.accesses},
            {"recorded", plan.passes},
            {"culled", plan.culled},
            {"groups", plan.groups},
            {"merged_groups", plan.merged_groups},
            {"merged_passes", plan.merged_passes},
            {"barriers", plan.barriers},
            {"barrier_commands", plan.barrier_commands},
            {"barriers_one_per_access", plan.barriers_one_per_access},
            {"declare_ns", json_of(result.declare_ns)},
            {"compile_ns", json_of(result.compile_ns)},
            {"cache_hit_ns", json_of(result.cache_hit_ns)},
            {"phases", list(result.phases, [](const PhaseTime& phase) {
                 return json{{"name", phase.name}, {"ns", json_of(phase.ns)}};
             })}};
}

json growth(const Growth& one) {
    return {{"family", one.family}, {"from", one.from}, {"to", one.to}, {"exponent", one.exponent}};
}

json memory(const MemoryResult& result) {
    return {{"family", result.family},
            {"passes", result.passes},
            {"placed_bytes", result.use.placed},
            {"unaliased_bytes", result.use.unaliased},
            {"lower_bound_bytes", result.use.lower_bound},
            {"worst_ratio", result.worst_ratio},
            {"worst_seed", result.worst_seed}};
}

json variant(const VariantResult& result) {
    return {{"name", result.name},
            {"frame_ms", json_of(result.frame_ms)},
            {"record_us", json_of(result.record_us)},
            {"render_passes", result.render_passes},
            {"barrier_commands", result.barrier_commands},
            {"barriers", result.barriers},
            {"transient_bytes", result.transient_bytes},
            {"same_image", result.same_image}};
}

json on_device(const DeviceResult& result) {
    return {{"family", result.family},
            {"passes", result.passes},
            {"width", result.width},
            {"height", result.height},
            {"first_frame_ms", result.first_frame_ms},
            {"variants", list(result.variants, variant)}};
}

json recorded(const RecordResult& result) {
    return {{"passes", result.passes},
            {"objects", result.objects},
            {"commands", result.commands},
            {"by_hand_us", json_of(result.by_hand_us)},
            {"through_graph_us", json_of(result.through_graph_us)},
            {"declared_anew_us", json_of(result.declared_anew_us)},
            {"overhead", result.overhead},
            {"overhead_declared_anew", result.overhead_declared_anew},
            {"same_commands", result.same_commands},
            {"same_image", result.same_image}};
}

json record_growth(const RecordGrowthResult& result) {
    return {{"family", result.family},
            {"passes", result.passes},
            {"render_passes", result.render_passes},
            {"barriers", result.barriers},
            {"record_us", json_of(result.record_us)},
            {"hit_us", json_of(result.hit_us)}};
}

}  // namespace

json to_json(const GraphReport& report) {
    return {{"benchmark", kReportKind},
            {"version", kReportVersion},
            {"seed", report.seed},
            {"repeat", report.repeat},
            {"processor", report.processor},
            {"device", report.device},
            {"compile", list(report.compiled, compiled)},
            {"growth", list(report.growth, growth)},
            {"memory", list(report.memory, memory)},
            {"on_device", list(report.on_device, on_device)},
            {"record", list(report.recorded, recorded)},
            {"record_growth", list(report.record_growth, record_growth)}};
}

}  // namespace splice::bench
