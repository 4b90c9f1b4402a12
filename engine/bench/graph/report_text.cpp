#include "engine/bench/graph/report_text.h"

#include "engine/bench/table.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>

namespace splice::bench {
namespace {

constexpr uint32_t kTypicalPasses = 1024;

double a_pass(const Sample& ns, const CompileResult& result) {
    return ns.median / result.passes;
}

std::string megabytes(uint64_t bytes) {
    return fmt::format("{:.1f}", static_cast<double>(bytes) / 1e6);
}

std::string yes_no(bool yes) {
    return yes ? "yes" : "NO";
}

std::string growth_table(const GraphReport& report) {
    std::vector<uint32_t> sizes;
    for (const CompileResult& result : report.compiled) {
        if (result.family == report.compiled.front().family) sizes.push_back(result.passes);
    }
    std::vector<std::string> header{"compile, ns a pass"};
    for (const uint32_t size : sizes)
        header.push_back(fmt::format("{}", size));
    header.emplace_back("exponent");
    Table table(header);
    for (size_t begin = 0; begin < report.compiled.size(); begin += sizes.size()) {
        const std::string& family = report.compiled[begin].family;
        std::vector<std::string> row{family};
        for (size_t i = 0; i < sizes.size(); ++i)
            row.push_back(
                fmt::format("{:.0f}", a_pass(report.compiled[begin + i].compile_ns, report.compiled[begin + i])));
        const auto growth = std::find_if(report.growth.begin(), report.growth.end(),
                                         [&](const Growth& one) { return one.family == family; });
        row.push_back(growth == report.growth.end() ? "" : fmt::format("{:.2f}", growth->exponent));
        table.add(row);
    }
    return table.text();
}

std::string phase_table(const std::vector<const CompileResult*>& results) {
    std::vector<std::string> header{"phases, ns a pass", "passes"};
    for (const PhaseTime& phase : results.front()->phases)
        header.push_back(phase.name);
    header.insert(header.end(), {"all", "least", "declare", "hit, us"});
    Table table(header);
    for (const CompileResult* result : results) {
        std::vector<std::string> row{result->family, fmt::format("{}", result->passes)};
        for (const PhaseTime& phase : result->phases)
            row.push_back(fmt::format("{:.0f}", a_pass(phase.ns, *result)));
        row.push_back(fmt::format("{:.0f}", a_pass(result->compile_ns, *result)));
        row.push_back(fmt::format("{:.0f}", result->compile_ns.minimum / result->passes));
        row.push_back(fmt::format("{:.0f}", a_pass(result->declare_ns, *result)));
        row.push_back(fmt::format("{:.1f}", result->cache_hit_ns.median / 1000));
        table.add(row);
    }
    return table.text();
}

std::string plan_table(const std::vector<const CompileResult*>& results) {
    Table table({"plan", "passes", "accesses", "culled", "groups", "merged", "of passes", "barriers", "one an access",
                 "commands"});
    for (const CompileResult* result : results) {
        const graph::PlanStatistics& plan = result->plan;
        table.add({result->family, fmt::format("{}", result->passes), fmt::format("{}", result->accesses),
                   fmt::format("{}", plan.culled), fmt::format("{}", plan.groups),
                   fmt::format("{}", plan.merged_groups), fmt::format("{}", plan.merged_passes),
                   fmt::format("{}", plan.barriers), fmt::format("{}", plan.barriers_one_per_access),
                   fmt::format("{}", plan.barrier_commands)});
    }
    return table.text();
}

std::string memory_table(const GraphReport& report) {
    Table table({"memory, MB", "passes", "no aliasing", "placed", "lower bound", "ratio", "worst ratio", "seed"});
    for (const MemoryResult& result : report.memory) {
        const double ratio = result.use.lower_bound == 0
                                 ? 1
                                 : static_cast<double>(result.use.placed) / static_cast<double>(result.use.lower_bound);
        table.add({result.family, fmt::format("{}", result.passes), megabytes(result.use.unaliased),
                   megabytes(result.use.placed), megabytes(result.use.lower_bound), fmt::format("{:.3f}", ratio),
                   fmt::format("{:.3f}", result.worst_ratio), fmt::format("{}", result.worst_seed)});
    }
    return table.text();
}

std::string device_table(const GraphReport& report) {
    Table table({"frames", "passes", "switches", "ms (min)", "(median)", "record us", "render passes", "barriers",
                 "commands", "MB", "same image"});
    for (const DeviceResult& result : report.on_device) {
        for (const VariantResult& variant : result.variants) {
            table.add({result.family, fmt::format("{}", result.passes), variant.name,
                       fmt::format("{:.2f}", variant.frame_ms.minimum), fmt::format("{:.2f}", variant.frame_ms.median),
                       fmt::format("{:.0f}", variant.record_us.median), fmt::format("{}", variant.render_passes),
                       fmt::format("{}", variant.barriers), fmt::format("{}", variant.barrier_commands),
                       megabytes(variant.transient_bytes), yes_no(variant.same_image)});
        }
    }
    return table.text();
}

std::string record_table(const GraphReport& report) {
    Table table({"record, us", "commands", "by hand", "graph", "declared anew", "overhead %", "anew %", "same commands",
                 "same image"});
    for (const RecordResult& result : report.recorded) {
        table.add({fmt::format("{} passes, {} objects", result.passes, result.objects),
                   fmt::format("{}", result.commands), fmt::format("{:.1f}", result.by_hand_us.median),
                   fmt::format("{:.1f}", result.through_graph_us.median),
                   fmt::format("{:.1f}", result.declared_anew_us.median), fmt::format("{:.1f}", result.overhead * 100),
                   fmt::format("{:.1f}", result.overhead_declared_anew * 100), yes_no(result.same_commands),
                   yes_no(result.same_image)});
    }
    return table.text();
}

std::string record_growth_table(const GraphReport& report) {
    Table table({"record, empty passes", "passes", "render passes", "barriers", "us", "least", "ns a pass", "hit, us"});
    for (const RecordGrowthResult& result : report.record_growth) {
        table.add({result.family, fmt::format("{}", result.passes), fmt::format("{}", result.render_passes),
                   fmt::format("{}", result.barriers), fmt::format("{:.1f}", result.record_us.median),
                   fmt::format("{:.1f}", result.record_us.minimum),
                   fmt::format("{:.0f}", result.record_us.median * 1000 / result.passes),
                   fmt::format("{:.1f}", result.hit_us.median)});
    }
    return table.text();
}

}  // namespace

std::vector<const CompileResult*> typical_results(const GraphReport& report) {
    std::vector<const CompileResult*> typical;
    for (const CompileResult& result : report.compiled) {
        const bool same_family = !typical.empty() && typical.back()->family == result.family;
        if (!same_family) {
            typical.push_back(&result);
        } else if (result.passes <= kTypicalPasses) {
            typical.back() = &result;
        }
    }
    return typical;
}

std::string report_text(const GraphReport& report) {
    const std::vector<const CompileResult*> typical = typical_results(report);
    std::string text = fmt::format("{}; {}; medians of {}, seed {}\n\n", report.processor,
                                   report.device.empty() ? "no device" : report.device, report.repeat, report.seed);
    text +=
        growth_table(report) + "\n" + phase_table(typical) + "\n" + plan_table(typical) + "\n" + memory_table(report);
    if (!report.on_device.empty()) text += "\n" + device_table(report);
    if (!report.record_growth.empty()) text += "\n" + record_growth_table(report);
    if (!report.recorded.empty()) text += "\n" + record_table(report);
    return text;
}

}  // namespace splice::bench
