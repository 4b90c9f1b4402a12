#include "engine/bench/frame/frame_command.h"

#include "engine/bench/report/changes.h"
#include "engine/bench/report_files.h"
#include "engine/capture/picture_size.h"
#include "preprocess/model_format/atomic_file.h"
#include "preprocess/model_format/error.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <optional>

namespace splice::bench {
namespace {

constexpr std::uint32_t kMostDisks = 50'000'000;
constexpr unsigned kMostRounds = 10'000;

template <typename Value, std::size_t N>
std::vector<Value> parse_names(const Names<Value, N>& names, const std::vector<std::string>& words,
                               const char* option) {
    std::vector<Value> values;
    for (const std::string& word : words) {
        const std::optional<Value> value = find_named(names, word);
        if (!value) throw UsageError(fmt::format("{}: '{}' is none of {}", option, word, listed(names)));
        values.push_back(*value);
    }
    return values;
}

}  // namespace

CLI::App& add_frame_command(CLI::App& program, FrameCommand& command) {
    CLI::App& app = *program.add_subcommand("frame", "Frame times of the splat backends, interleaved");
    FrameBenchOptions& options = command.options;
    app.add_option("FILE", options.files,
                   "Models, scenes or meshes; without any and without --count: the bumpy sphere of 50k, 300k and 1M "
                   "disks, ten deep, the last from afar, too, and a baseline of sprites without render graph and scene")
        ->check(CLI::ExistingFile);
    app.add_option("--count", options.counts, "Bumpy spheres of so many disks, separated by commas")
        ->delimiter(',')
        ->check(CLI::Range(1U, kMostDisks));
    app.add_flag("--far", options.far, "Those of --count from so far that they cover 13 % of the frame, too");
    app.add_option("--backend", command.backends, "Only these of " + listed(kBackendNames) + ", separated by commas")
        ->delimiter(',');
    app.add_option("--shading", command.shadings, "Any of " + listed(kShadingNames) + ", separated by commas")
        ->delimiter(',')
        ->capture_default_str();
    app.add_option("--size", command.sizes, "Pixels, WIDTHxHEIGHT, separated by commas")
        ->delimiter(',')
        ->capture_default_str();
    app.add_option("--points-below", options.points_below, "As splice-capture's, 0 to 64 pixels")
        ->check(CLI::Range(0.0, kLargestPoint));
    app.add_option("--merge", options.merge_px, "As splice-capture's, 0 to 64 pixels")
        ->check(CLI::Range(0.0, kMostMergePixels));
    app.add_option("--rounds", options.rounds, "Timed frames a variant")
        ->check(CLI::Range(1U, kMostRounds))
        ->capture_default_str();
    app.add_option("--device", options.device, "auto, cpu, or an index of splice-capture --list-devices")
        ->capture_default_str();
    app.add_option("--json", command.json, "Write all figures to this file");
    app.add_option("--html", command.html, "Write a page with a drawing of each scene's passes to this file");
    app.add_option("--vs", command.versus, "Print what moved since this report of --json");
    return app;
}

void run_frame_command(FrameCommand& command) {
    std::vector<NamedFile> inputs = files_of_scenes("FILE", command.options.files);
    inputs.push_back({"--vs", command.versus});
    check_report_files(inputs, {{"--json", command.json}, {"--html", command.html}});
    FrameBenchOptions& options = command.options;
    options.sizes.clear();
    for (const std::string& size : command.sizes)
        options.sizes.push_back(parse_size(size));
    options.backends = parse_names(kBackendNames, command.backends, "--backend");
    options.shadings = parse_names(kShadingNames, command.shadings, "--shading");
    options.bare = command.backends.empty();
    std::optional<nlohmann::json> before;
    if (!command.versus.empty()) before = read_report_of({kFrameReportKind, kFrameReportVersion}, command.versus);
    const FrameReport report = bench_frame(options);
    const nlohmann::json json = frame_report_json(report);
    fmt::print("{}", frame_report_text(report));
    if (before) fmt::print("\n{}", compare_frame_reports(*before, json, command.versus.string()));
    if (!command.json.empty())
        write_text_file(command.json, json.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n");
    if (!command.html.empty()) write_text_file(command.html, frame_report_html(report));
}

}  // namespace splice::bench
