#include "engine/bench/graph/figures.h"
#include "engine/bench/graph/report_text.h"
#include "engine/bench/report/svg.h"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

namespace splice::bench {
namespace {

constexpr double kWidth = 1040, kLeft = 110, kRight = 90, kRow = 34, kBar = 20, kFont = 12;
constexpr size_t kColours = 9;

/// Names of the colours, in rows of whole names. Returns the height used.
double draw_legend(Svg& svg, double top, const std::vector<std::string>& names) {
    double x = kLeft, y = top;
    for (size_t i = 0; i < names.size(); ++i) {
        const double width = 18 + text_width(names[i], kFont) + 14;
        if (x + width > kWidth) {
            x = kLeft;
            y += 20;
        }
        svg.rectangle(x, y + 2, 12, 12, fmt::format("f{}", i % kColours), {}, 2);
        svg.text(x + 17, y + 12, names[i], "label");
        x += width;
    }
    return y + 28 - top;
}

}  // namespace

std::string draw_phases(const GraphReport& report) {
    const std::vector<const CompileResult*> results = typical_results(report);
    std::vector<std::string> names;
    for (const PhaseTime& phase : results.front()->phases)
        names.push_back(phase.name);
    double longest = 0;
    for (const CompileResult* result : results) {
        double sum = 0;
        for (const PhaseTime& phase : result->phases)
            sum += phase.ns.median / result->passes;
        longest = std::max(longest, sum);
    }
    constexpr double kLegend = 50;
    Svg svg(kWidth, kLegend + kRow * static_cast<double>(results.size()), "Compile time a pass, by phase");
    double y = draw_legend(svg, 0, names);
    for (const CompileResult* result : results) {
        svg.text(kLeft - 10, y + kBar / 2 + 4, result->family, "label strong", Anchor::end);
        double x = kLeft, sum = 0;
        for (size_t i = 0; i < result->phases.size(); ++i) {
            const double ns = result->phases[i].ns.median / result->passes;
            const double width = ns / longest * (kWidth - kLeft - kRight);
            svg.rectangle(x, y, width, kBar, fmt::format("f{}", i),
                          fmt::format("{}, {}: {:.0f} ns a pass", result->family, names[i], ns));
            x += width;
            sum += ns;
        }
        svg.text(x + 8, y + kBar / 2 + 4, fmt::format("{:.0f} ns", sum), "label");
        y += kRow;
    }
    return svg.finish();
}

std::string draw_barriers(const GraphReport& report) {
    const std::vector<const CompileResult*> results = typical_results(report);
    uint64_t most = 1;
    for (const CompileResult* result : results)
        most = std::max({most, result->plan.barriers, result->plan.barriers_one_per_access});
    Svg svg(kWidth, 30 + (kRow + 8) * static_cast<double>(results.size()), "Barriers of the plan and one an access");
    double y = draw_legend(svg, 0, {"barriers of the plan", "commands that carry them", "one an access"});
    for (const CompileResult* result : results) {
        svg.text(kLeft - 10, y + 19, result->family, "label strong", Anchor::end);
        const auto bar = [&](double top, uint64_t count, int colour) {
            const double width = static_cast<double>(count) / static_cast<double>(most) * (kWidth - kLeft - kRight);
            svg.rectangle(kLeft, top, width, 9, fmt::format("f{}", colour), {}, 2);
            svg.text(kLeft + width + 6, top + 9, fmt::format("{}", count), "small");
        };
        bar(y, result->plan.barriers, 0);
        bar(y + 11, result->plan.barrier_commands, 1);
        bar(y + 22, result->plan.barriers_one_per_access, 2);
        y += kRow + 8;
    }
    return svg.finish();
}

std::string draw_memory(const GraphReport& report) {
    std::vector<std::string> sizes;
    double worst = 1.1;
    for (const MemoryResult& result : report.memory) {
        if (result.family == report.memory.front().family) sizes.push_back(fmt::format("{} passes", result.passes));
        worst = std::max(worst, result.worst_ratio);
    }
    const double row = 8 * static_cast<double>(sizes.size()) + 8;
    const auto families = static_cast<double>(report.memory.size() / std::max<size_t>(sizes.size(), 1));
    const auto x_of = [&](double ratio) { return kLeft + 8 + (ratio - 1) / (worst - 1) * (kWidth - kLeft - kRight); };
    const double legend = sizes.size() > 8 ? 50 : 30;
    Svg svg(kWidth, legend + row * families + 30, "Placed bytes over the lower bound");
    const double top = draw_legend(svg, 0, sizes), bottom = top + row * families;
    const double step = worst > 1.25 ? 0.1 : 0.05;
    for (int tick = 0; 1 + step * tick <= worst + 1e-9; ++tick) {
        const double ratio = 1 + step * tick;
        svg.line(x_of(ratio), top, x_of(ratio), bottom, "grid");
        svg.text(x_of(ratio), bottom + 16, fmt::format("{:.2f}", ratio), "label", Anchor::middle);
    }
    svg.line(x_of(1.1), top, x_of(1.1), bottom, "bound");
    double worst_of_family = 1;
    for (size_t i = 0; i < report.memory.size(); ++i) {
        const MemoryResult& result = report.memory[i];
        const size_t size = i % sizes.size();
        const double y = top + row * static_cast<double>(i / sizes.size());
        if (size == 0) {
            svg.line(kLeft, y, kWidth - kRight + 8, y, "grid");
            svg.text(kLeft - 10, y + row / 2 + 4, result.family, "label strong", Anchor::end);
            worst_of_family = 1;
        }
        worst_of_family = std::max(worst_of_family, result.worst_ratio);
        svg.circle(x_of(result.worst_ratio), y + 8 + 8 * static_cast<double>(size), 4.5,
                   fmt::format("f{}", size % kColours),
                   fmt::format("{}, {} passes: {:.3f} with seed {}", result.family, result.passes, result.worst_ratio,
                               result.worst_seed));
        if (size + 1 == sizes.size())
            svg.text(kWidth - kRight + 24, y + row / 2 + 4, fmt::format("{:.3f}", worst_of_family), "label strong");
    }
    return svg.finish();
}

}  // namespace splice::bench
