#include "engine/bench/frame/frame_report.h"

#include "engine/bench/report/changes.h"
#include "engine/bench/table.h"

#include <fmt/format.h>

#include <algorithm>

namespace splice::bench {
namespace {
using nlohmann::json;

const FrameRow* find_row(const FrameReport& report, std::string_view scene, std::string_view backend) {
    const auto found = std::find_if(report.rows.begin(), report.rows.end(), [&](const FrameRow& row) {
        return row.scene == scene && row.backend == backend && row.shading == "surfel";
    });
    return found == report.rows.end() ? nullptr : &*found;
}

std::string variant_of(const json& row) {
    return fmt::format("{}, {}, {}, {}x{}", row.at("scene").get<std::string>(), row.at("backend").get<std::string>(),
                       row.at("shading").get<std::string>(), row.at("width").get<std::uint32_t>(),
                       row.at("height").get<std::uint32_t>());
}

Figures figures_of(const json& report) {
    Figures figures;
    for (const json& row : report.at("frames")) {
        const std::string name = variant_of(row);
        add_time(figures, name + ": frame, ms", row.at("frame_ms"), 1);
        add_time(figures, name + ": cpu, ms", row.at("cpu_ms"), 1);
        for (const json& pass : row.at("passes"))
            add_time(figures, fmt::format("{}: {}, ms", name, pass.at("name").get<std::string>()), pass.at("gpu_ms"),
                     1);
        for (const char* count : {"surfels", "covered_pixels", "fragments"})
            add_count(figures, fmt::format("{}: {}", name, count), row.at(count));
    }
    return figures;
}

std::string passes_text(const FrameRow& row) {
    std::string text;
    for (const PassSample& pass : row.passes)
        text += fmt::format("{}{} {:.1f} ({:.1f})", text.empty() ? "" : ", ", pass.name, pass.gpu_ms.median,
                            pass.gpu_ms.minimum);
    return text;
}

}  // namespace

std::vector<FrameGoal> goals_of(const FrameReport& report) {
    std::vector<FrameGoal> goals;
    for (const auto& [scene, goal] :
         {std::pair("bumpy-sphere 50000", 4.0), {"bumpy-sphere 300000", 3.0}, {"bumpy-sphere 1000000", 3.0}}) {
        const FrameRow *sprite = find_row(report, scene, "sprite"), *chosen = find_row(report, scene, "auto");
        if (!sprite || !chosen) continue;
        goals.push_back({fmt::format("{}: times as fast as sprite", scene),
                         sprite->frame_ms.median / chosen->frame_ms.median, goal});
        if (const FrameRow* bare = find_row(report, scene, "bare"))
            goals.push_back({fmt::format("{}: sprite over the bare baseline", scene),
                             sprite->frame_ms.median / bare->frame_ms.median, 1.2, true});
    }
    const FrameRow *near = find_row(report, "bumpy-sphere 1000000", "auto"),
                   *far = find_row(report, "bumpy-sphere 1000000 far", "auto");
    if (near && far)
        goals.push_back({fmt::format("a million surfels on {:.0f} % of the frame over those on {:.0f} %",
                                     100 * far->coverage(), 100 * near->coverage()),
                         far->frame_ms.median / near->frame_ms.median, 0.6, true});
    return goals;
}

std::string frame_report_text(const FrameReport& report) {
    Table table({"scene", "backend", "shading", "size", "surfels", "min ms", "median ms", "cpu ms", "M surfels/s",
                 "M fragments/s", "speed-up", "cpu speed-up"});
    const FrameRow* first = nullptr;  // of the scene
    const auto number = [](double value, int digits) { return fmt::format("{:.{}f}", value, digits); };
    for (const FrameRow& row : report.rows) {
        if (!first || first->scene != row.scene || first->width != row.width || first->height != row.height)
            first = &row;
        table.add({row.scene, row.backend, row.shading, fmt::format("{}x{}", row.width, row.height),
                   std::to_string(row.surfels), number(row.frame_ms.minimum, 1), number(row.frame_ms.median, 1),
                   number(row.cpu_ms.median, 1), number(row.per_second(row.surfels) * 1e-6, 2),
                   number(row.per_second(row.fragments) * 1e-6, 1),
                   number(first->frame_ms.median / row.frame_ms.median, 2),
                   number(first->cpu_ms.median / row.cpu_ms.median, 2)});
    }
    std::string text = fmt::format("{}, {} frames each, interleaved\n{}\npasses: median (least) ms\n", report.device,
                                   report.rounds, table.text());
    Table passes({"scene", "backend", "shading", "coverage", "drawn by", "passes"});
    for (const FrameRow& row : report.rows) {
        std::string drawn_by;
        for (const auto& [backend, surfels] : row.drawn_by)
            drawn_by += fmt::format("{}{} {}", drawn_by.empty() ? "" : ", ", backend, surfels);
        passes.add({row.scene, row.backend, row.shading, fmt::format("{:.1f} %", 100 * row.coverage()), drawn_by,
                    passes_text(row)});
    }
    text += passes.text();
    const std::vector<FrameGoal> goals = goals_of(report);
    if (goals.empty()) return text;
    Table table_of_goals({"ratio", "reached", "goal", ""});
    for (const FrameGoal& goal : goals)
        table_of_goals.add({goal.meaning, number(goal.reached, 2),
                            fmt::format("{} {:.2f}", goal.at_most ? "at most" : "at least", goal.goal),
                            goal.met() ? "met" : "missed"});
    return text + "\n" + table_of_goals.text();
}

json frame_report_json(const FrameReport& report) {
    json all{{"benchmark", kFrameReportKind},
             {"version", kFrameReportVersion},
             {"device", report.device},
             {"rounds", report.rounds},
             {"frames", json::array()}};
    for (const FrameRow& row : report.rows) {
        json one{{"scene", row.scene},
                 {"backend", row.backend},
                 {"shading", row.shading},
                 {"width", row.width},
                 {"height", row.height},
                 {"surfels", row.surfels},
                 {"triangles", row.triangles},
                 {"covered_pixels", row.covered_pixels},
                 {"fragments", row.fragments},
                 {"surfels_per_second", row.per_second(row.surfels)},
                 {"fragments_per_second", row.per_second(row.fragments)},
                 {"frame_ms", json_of(row.frame_ms)},
                 {"cpu_ms", json_of(row.cpu_ms)},
                 {"drawn_by", json::object()},
                 {"passes", json::array()}};
        for (const auto& [backend, surfels] : row.drawn_by)
            one["drawn_by"][backend] = surfels;
        for (const PassSample& pass : row.passes)
            one["passes"].push_back({{"name", pass.name}, {"gpu_ms", json_of(pass.gpu_ms)}});
        all["frames"].push_back(std::move(one));
    }
    return all;
}

std::string compare_frame_reports(const json& before, const json& now, const std::string& old_name) {
    return change_report(before, now, old_name, figures_of, {"device", "rounds"});
}

}  // namespace splice::bench
