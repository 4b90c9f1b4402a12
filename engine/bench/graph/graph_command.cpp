#include "engine/bench/graph/graph_command.h"

#include "engine/bench/bench_view.h"
#include "engine/bench/graph/compare.h"
#include "engine/bench/graph/families.h"
#include "engine/bench/graph/report_html.h"
#include "engine/bench/graph/report_json.h"
#include "engine/bench/graph/report_text.h"
#include "engine/bench/report_files.h"
#include "preprocess/model_format/atomic_file.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <optional>

namespace splice::bench {
namespace {

constexpr uint32_t kMostPasses = 1U << 16, kMostRounds = 10'000;

std::string explanation() {
    std::string text =
        "How fast the render graph compiles and records, and what its plans cost.\n\n"
        "Compiles graphs of growing size without a device, then runs frames on one: merged and not, aliased and not,\n"
        "with one barrier an access, all in turn in one process; and records a frame through the graph and by hand.\n\n"
        "Families:\n";
    for (const Family& family : families())
        text += fmt::format("  {:14} {}\n", family.name, family.description);
    return text +
           fmt::format("  {:14} views of this renderer's own frame, 5 passes each (takes a device)\n\n", "frame") +
           "To see what a change does, on a machine that does nothing else:\n"
           "  splice-bench graph --json before.json\n"
           "  splice-bench graph --vs before.json --html after.html";
}

}  // namespace

CLI::App& add_graph_command(CLI::App& program, GraphCommand& command) {
    CLI::App& app = *program.add_subcommand("graph", "The render graph: compile times, plans, memory, recording");
    app.footer(explanation());
    GraphBenchOptions& options = command.options;
    app.add_option("--families", options.families, "Only these, separated by commas")->delimiter(',');
    app.add_option("--sizes", options.sizes, "Numbers of passes, separated by commas")
        ->delimiter(',')
        ->check(CLI::Range(4U, kMostPasses))
        ->capture_default_str();
    app.add_option("--seed", options.seed, "Of random graphs and sizes")->capture_default_str();
    app.add_option("--repeat", options.repeat, "Rounds; medians are taken over them")
        ->check(CLI::Range(1U, kMostRounds))
        ->capture_default_str();
    app.add_option("--device", command.device, "auto, cpu, or an index of splice-capture --list-devices")
        ->capture_default_str();
    app.add_flag_callback(
        "--no-device", [&] { options.use_device = false; }, "Compile only; leaves out the family 'frame'");
    app.add_option("--json", command.json, "Write all figures to this file");
    app.add_option("--html", command.html, "Write a page with plots, memory maps and drawings of graphs to this file");
    app.add_option("--vs", command.versus, "Print what moved since this report of --json");
    return app;
}

void run_graph_command(GraphCommand& command) {
    check_report_files({{"--vs", command.versus}}, {{"--json", command.json}, {"--html", command.html}});
    std::optional<nlohmann::json> before;
    if (!command.versus.empty()) before = read_report(command.versus);
    command.options.device = gpu::parse_device_choice(command.device);
    command.options.progress = show_progress;
    const GraphReport report = bench_graph(command.options);
    const nlohmann::json json = to_json(report);
    fmt::print("{}", report_text(report));
    if (before) fmt::print("\n{}", compare_reports(*before, json, command.versus.string()));
    if (!command.json.empty())
        write_text_file(command.json, json.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n");
    if (!command.html.empty()) write_text_file(command.html, report_html(report));
}

}  // namespace splice::bench
