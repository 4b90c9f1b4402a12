#include "engine/bench/graph/report_html.h"

#include "engine/bench/graph/figures.h"
#include "engine/bench/graph/report_text.h"
#include "engine/bench/report/html_parts.h"
#include "engine/bench/report/svg.h"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>
#include <vector>

namespace splice::bench {
namespace {

constexpr uint32_t kGoalPasses = 1024;

std::string compile_tiles(const GraphReport& report) {
    std::string tiles;
    for (const CompileResult* result : typical_results(report)) {
        if (result->family != "layered") continue;
        const double ns = result->compile_ns.median / result->passes;
        tiles += tile(fmt::format("{:.0f} ns", ns), fmt::format("a pass to compile {} passes, layered", result->passes),
                      result->passes == kGoalPasses ? "goal: at most 1000" : "the goal is of 1,024 passes",
                      result->passes != kGoalPasses || ns <= 1000);
        const double hit_us = result->cache_hit_ns.median / 1000;
        tiles += tile(fmt::format("{:.1f} us", hit_us), "to find that it is compiled already", "goal: below 10",
                      hit_us < 10);
        const double saved = 1 - static_cast<double>(result->plan.barriers) /
                                     static_cast<double>(std::max<uint64_t>(result->plan.barriers_one_per_access, 1));
        tiles +=
            tile(fmt::format("{:.0f} %", saved * 100), "fewer barriers than one an access", "the same graph", true);
    }
    for (const Growth& growth : report.growth) {
        if (growth.family == "layered")
            tiles += tile(fmt::format("{:.2f}", growth.exponent),
                          fmt::format("growth exponent, {} to {} passes", growth.from, growth.to), "goal: at most 1.10",
                          growth.exponent <= 1.1);
    }
    return tiles;
}

std::string tiles_of(const GraphReport& report) {
    std::string tiles = compile_tiles(report);
    double worst = 0;
    for (const MemoryResult& result : report.memory)
        worst = std::max(worst, result.worst_ratio);
    if (worst > 0)
        tiles += tile(fmt::format("{:.3f}", worst), "placed bytes over the lower bound, worst family and seed",
                      "goal: at most 1.10", worst <= 1.1);
    for (const RecordResult& result : report.recorded) {
        tiles += tile(fmt::format("{:+.1f} %", result.overhead * 100),
                      fmt::format("to record through the graph, {} draw{} a geometry pass", result.objects,
                                  result.objects == 1 ? "" : "s"),
                      "goal: at most +5", result.overhead <= 0.05);
    }
    return "<div class=\"tiles\">\n" + tiles + "</div>\n";
}

std::string device_section(const GraphReport& report) {
    if (report.on_device.empty()) return "";
    std::vector<std::vector<std::string>> rows;
    for (const DeviceResult& result : report.on_device) {
        for (const VariantResult& variant : result.variants) {
            rows.push_back({fmt::format("{} {}", result.family, result.passes), variant.name,
                            fmt::format("{:.2f}", variant.frame_ms.minimum),
                            fmt::format("{:.2f}", variant.frame_ms.median),
                            fmt::format("{:.0f}", variant.record_us.median), fmt::format("{}", variant.render_passes),
                            fmt::format("{} / {}", variant.barriers, variant.barrier_commands),
                            fmt::format("{:.2f}", static_cast<double>(variant.transient_bytes) / 1e6),
                            variant.same_image ? "same" : "DIFFERS"});
        }
    }
    return "<section>\n<h2>On the device</h2>\n<p class=\"caption\">" + escape_markup(report.device) +
           "; all variants in turn, one frame each a round. A frame is recorded, submitted and waited for.</p>\n" +
           html_table({"graph", "switches", "ms, least", "median", "record us", "render passes", "barriers / commands",
                       "transient MB", "image"},
                      rows) +
           "</section>\n";
}

std::string record_section(const GraphReport& report) {
    if (report.recorded.empty()) return "";
    std::vector<std::vector<std::string>> rows;
    for (const RecordResult& result : report.recorded) {
        rows.push_back(
            {fmt::format("{}", result.objects), fmt::format("{}", result.commands),
             fmt::format("{:.1f}", result.by_hand_us.median), fmt::format("{:.1f}", result.through_graph_us.median),
             fmt::format("{:+.1f} %", result.overhead * 100), fmt::format("{:.1f}", result.declared_anew_us.median),
             fmt::format("{:+.1f} %", result.overhead_declared_anew * 100), result.same_commands ? "same" : "DIFFER",
             result.same_image ? "same" : "DIFFERS"});
    }
    return "<section>\n<h2>Recording, through the graph and by hand</h2>\n<p class=\"caption\">A deferred view of 32 "
           "passes; by hand everything is filled in beforehand. Microseconds, median.</p>\n" +
           html_table({"draws a geometry pass", "commands", "by hand", "graph kept", "overhead", "declared anew",
                       "overhead", "commands", "image"},
                      rows) +
           "</section>\n";
}

std::string record_growth_section(const GraphReport& report) {
    if (report.record_growth.empty()) return "";
    std::vector<std::vector<std::string>> rows;
    for (const RecordGrowthResult& result : report.record_growth) {
        rows.push_back({fmt::format("{} {}", result.family, result.passes), fmt::format("{}", result.render_passes),
                        fmt::format("{}", result.barriers), fmt::format("{:.1f}", result.record_us.median),
                        fmt::format("{:.0f}", result.record_us.median * 1000 / result.passes),
                        fmt::format("{:.1f}", result.hit_us.median)});
    }
    return "<section>\n<h2>Recording against size</h2>\n<p class=\"caption\">Passes that record nothing of their own: "
           "what the graph adds. A hit finds the plan of a graph declared anew.</p>\n" +
           html_table({"graph", "render passes", "barriers", "us", "ns a pass", "hit, us"}, rows) + "</section>\n";
}

std::string example_sections(const GraphReport& report) {
    std::string text;
    for (const ExampleGraph& example : report.examples) {
        text += figure(fmt::format("The {} graph", example.family),
                       "Top to bottom in order of dependency. Boxed together: the subpasses of one render pass. The "
                       "lines are resources; rest the pointer on one for its name.",
                       draw_graph(example));
        text += figure(fmt::format("Memory of the {} graph", example.family),
                       "One rectangle a transient resource: the groups in which it lives, and its bytes in the heap.",
                       draw_lifetimes(example));
    }
    return text;
}

}  // namespace

std::string report_html(const GraphReport& report) {
    const std::string caption =
        fmt::format("{}; {}; medians of {} rounds; seed {}", report.processor,
                    report.device.empty() ? "no device" : report.device, report.repeat, report.seed);
    std::string body;
    body += tiles_of(report);
    body += figure("Compile time a pass",
                   "All phases, image sizes log-uniform. Level is linear; the exponent is of the total from 64 to "
                   "4,096 passes.",
                   draw_growth(report));
    const uint32_t passes = typical_results(report).front()->passes;
    body += figure(fmt::format("Where the time goes, {} passes", passes), "Nanoseconds a pass.", draw_phases(report));
    body += figure(fmt::format("Barriers, {} passes", passes),
                   "One an access: what a recorder needs that looks at one access at a time.", draw_barriers(report));
    body += figure("Aliased memory over the lower bound",
                   "The lower bound is the most that is alive at once. The worst of the seeds; dashed: the goal, 1.10.",
                   draw_memory(report));
    body += example_sections(report);
    body += device_section(report) + record_growth_section(report) + record_section(report);
    return page("Render graph benchmark", caption, body);
}

}  // namespace splice::bench
