#include "engine/bench/frame/frame_report.h"
#include "engine/bench/report/html_parts.h"
#include "engine/bench/report/svg.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

namespace splice::bench {
namespace {

constexpr double kWidth = 1040, kLeft = 250, kRight = 90, kRow = 26, kBar = 16, kFont = 12, kLegend = 26;
constexpr std::size_t kColours = 9;

std::string variant_name(const FrameRow& row) {
    return fmt::format("{}{}, {}x{}", row.backend, row.shading == "surfel" ? "" : ", " + row.shading, row.width,
                       row.height);
}

/// One bar a variant of the scene, what each pass takes of it.
std::string draw_passes(const std::vector<const FrameRow*>& rows) {
    std::map<std::string, std::size_t> colours;  // by pass, in order of appearance
    std::vector<std::string> names;
    double longest = 0;
    for (const FrameRow* row : rows) {
        longest = std::max(longest, row->frame_ms.median);
        for (const PassSample& pass : row->passes)
            if (colours.emplace(pass.name, names.size()).second) names.push_back(pass.name);
    }
    double legend_rows = 1, x = 0;
    for (const std::string& name : names) {
        const double width = 32 + text_width(name, kFont);
        if (x + width > kWidth) {
            ++legend_rows;
            x = 0;
        }
        x += width;
    }
    const double top = kLegend * legend_rows;
    Svg svg(kWidth, top + kRow * static_cast<double>(rows.size()), "Frame time by pass");
    double legend_y = 0;
    x = 0;
    for (const std::string& name : names) {
        const double width = 32 + text_width(name, kFont);
        if (x + width > kWidth) {
            legend_y += kLegend;
            x = 0;
        }
        svg.rectangle(x, legend_y + 2, 12, 12, fmt::format("f{}", colours[name] % kColours), {}, 2);
        svg.text(x + 17, legend_y + 12, name, "label");
        x += width;
    }
    double y = top;
    const double unit = (kWidth - kLeft - kRight) / longest;
    for (const FrameRow* row : rows) {
        svg.text(kLeft - 10, y + kBar / 2 + 4, variant_name(*row), "label strong", Anchor::end);
        double at = kLeft;
        for (const PassSample& pass : row->passes) {
            const double width = pass.gpu_ms.median * unit;
            svg.rectangle(
                at, y, width, kBar, fmt::format("f{}", colours[pass.name] % kColours),
                fmt::format("{}: {:.1f} ms, at least {:.1f}", pass.name, pass.gpu_ms.median, pass.gpu_ms.minimum));
            at += width;
        }
        svg.text(std::max(at, kLeft + row->frame_ms.median * unit) + 8, y + kBar / 2 + 4,
                 fmt::format("{:.1f} ms", row->frame_ms.median), "label");
        y += kRow;
    }
    return svg.finish();
}

std::string table_of(const FrameReport& report) {
    std::vector<std::vector<std::string>> rows;
    for (const FrameRow& row : report.rows)
        rows.push_back({row.scene, variant_name(row), fmt::format("{}", row.surfels),
                        fmt::format("{:.1f}", row.frame_ms.minimum), fmt::format("{:.1f}", row.frame_ms.median),
                        fmt::format("{:.1f}", row.cpu_ms.median), fmt::format("{:.1f} %", 100 * row.coverage()),
                        fmt::format("{:.2f}", row.per_second(row.surfels) * 1e-6),
                        fmt::format("{:.1f}", row.per_second(row.fragments) * 1e-6)});
    return html_table({"scene", "variant", "surfels", "ms, least", "median", "cpu", "coverage", "M surfels/s",
                       "M useful fragments/s"},
                      rows);
}

}  // namespace

std::string frame_report_html(const FrameReport& report) {
    std::string body;
    for (const FrameGoal& goal : goals_of(report))
        body += tile(fmt::format("{:.2f}", goal.reached), goal.meaning,
                     fmt::format("goal: {} {:.1f}", goal.at_most ? "at most" : "at least", goal.goal), goal.met());
    if (!body.empty()) body = "<div class=\"tiles\">\n" + body + "</div>\n";
    std::vector<std::string> scenes;
    std::map<std::string, std::vector<const FrameRow*>> rows;
    for (const FrameRow& row : report.rows) {
        if (rows[row.scene].empty()) scenes.push_back(row.scene);
        rows[row.scene].push_back(&row);
    }
    for (const std::string& scene : scenes)
        body += figure(scene, "Milliseconds a frame, medians; what lies behind the bars is not timed by pass.",
                       draw_passes(rows[scene]));
    body += "<section>\n<h2>All variants</h2>\n" + table_of(report) + "</section>\n";
    return page("Frame benchmark",
                fmt::format("{}; {} frames each, variants of a scene in turn", report.device, report.rounds), body);
}

}  // namespace splice::bench
