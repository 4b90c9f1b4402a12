// splice-bench: measures the bake, the frames and their truth, and the render graph. Not a test: figures depend on the
// machine.
#include "engine/bench/bench_bake.h"
#include "engine/bench/bench_quality.h"
#include "engine/bench/cloud_command.h"
#include "engine/bench/confetti_command.h"
#include "engine/bench/costs_command.h"
#include "engine/bench/frame/frame_command.h"
#include "engine/bench/graph/graph_command.h"
#include "engine/bench/levels_command.h"
#include "engine/bench/quality_command.h"
#include "engine/bench/report_files.h"
#include "engine/capture/picture_size.h"
#include "engine/scene/scene_file.h"
#include "preprocess/build_model/program_main.h"
#include "preprocess/model_format/atomic_file.h"
#include "preprocess/model_format/error.h"

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstdlib>
#include <tuple>

namespace {
using namespace splice;
namespace fs = std::filesystem;

struct CommandLine {
    std::vector<fs::path> files;
    fs::path folder;
    fs::path json;
    bench::BakeBenchOptions bake;
    bench::QualityOptions quality;
    std::string size = "512x512";
};

fs::path default_folder() {
    const char* from_environment = std::getenv("SPLICE_MODELS");
    return from_environment ? from_environment : "../shared/models";
}

void add_common(CLI::App& command, CommandLine& line) {
    command.add_option("MESH", line.files,
                       "Meshes; without any: the thesis's five models and Debian's bunny.obj, if found");
    command
        .add_option("--models", line.folder,
                    "Folder of the thesis's models, in its subfolder meshes (or $SPLICE_MODELS)")
        ->capture_default_str();
    command.add_option("--json", line.json, "Write all figures to this file");
}

void add_quality(CLI::App& command, CommandLine& line, std::size_t directions) {
    line.quality.directions = directions;
    command.add_option("--device", line.quality.device, "auto, cpu, or an index of splice-capture --list-devices")
        ->capture_default_str();
    command.add_option("--size", line.size, "Pixels, WIDTHxHEIGHT")->capture_default_str();
    command.add_flag("--orthographic", line.quality.orthographic, "Parallel rays");
    command.add_option("--epsilon-scale", line.quality.epsilon_scale, "Times each surfel's depth offset, 0 to 100")
        ->check(CLI::Range(0.0, 100.0))
        ->capture_default_str();
    command.add_flag_callback(
        "--two-sided", [&] { line.quality.sides = Sides::kTwoSided; }, "Cull nothing, whatever the bake decided");
    command
        .add_option("--h-max", line.quality.bake.sampling.h_max, "Largest surfel spacing, unit-box units, 1e-5 to 1")
        ->check(CLI::Range(1e-5, 1.0))
        ->capture_default_str();
    command
        .add_option("--sagitta", line.quality.bake.sampling.sagitta,
                    "How far the surface may bend away within a spacing, unit-box units, 1e-7 to 1")
        ->check(CLI::Range(1e-7, 1.0))
        ->capture_default_str();
    command
        .add_option("--crease-spacing", line.quality.bake.sampling.crease_spacing,
                    "Surfel spacing at creases and borders, unit-box units, 1e-5 to 1")
        ->check(CLI::Range(1e-5, 1.0))
        ->capture_default_str();
    command
        .add_option("--triangle-share", line.quality.bake.cluster.triangle_share,
                    "Share of the triangles that the bake keeps as triangles, 0..1")
        ->check(CLI::Range(0.0, 1.0));
    command.add_option("--pictures", line.quality.pictures, "Write frames, reference and errors to this folder");
}

ForcedRepresentation representation_of_name(const std::string& name) {
    if (name == "hybrid") return ForcedRepresentation::kHybrid;
    if (name == "triangles") return ForcedRepresentation::kTriangles;
    if (name == "surfels") return ForcedRepresentation::kSurfels;
    throw CLI::ValidationError("--representation", "'" + name + "' is none of hybrid, triangles, surfels");
}

void check_files(const std::vector<bench::BenchModel>& models, const fs::path& report) {
    std::vector<NamedFile> inputs;
    for (const bench::BenchModel& model : models)
        inputs.push_back({"MESH", model.path});
    bench::check_report_files(inputs, {{"--json", report}});
}

int run(int argc, char** argv) {
    CommandLine line;
    line.folder = default_folder();
    CLI::App app(
        "Measures splice: bake times and memory, frame times, truth and holes against a ray-cast reference, the render "
        "graph.");
    app.require_subcommand(1);

    CLI::App& bake = *app.add_subcommand("bake", "Seconds a stage, peak memory and results of splice-bake");
    add_common(bake, line);
    bake.add_option("--runs", line.bake.runs, "Medians are taken over this many bakes, 1 to 1000")
        ->check(CLI::Range(1, 1000))
        ->capture_default_str();
    bake.add_option("--with", line.bake.arguments, "An argument for splice-bake, e.g. --with=--triangle-share=0.19")
        ->take_all();

    CommandLine capture_line = line, holes_line = line;
    CLI::App& capture =
        *app.add_subcommand("capture", "PSNR of hybrid and triangles against 64 samples a pixel; frame times");
    add_common(capture, capture_line);
    add_quality(capture, capture_line, 1);
    capture
        .add_option("--directions", capture_line.quality.directions,
                    "1: the default view; more: of 26 around the model")
        ->check(CLI::Range(1, 26))
        ->capture_default_str();
    capture.add_option("--frames", capture_line.quality.frames, "Timed frames a model, 1 to 100000")
        ->check(CLI::Range(1, 100000))
        ->capture_default_str();
    capture
        .add_option("--antialias", capture_line.quality.antialias,
                    "Samples along each side of a pixel, of the pictures and not of the times, 1 to 8")
        ->check(CLI::Range(1U, kMostSamplesPerSide))
        ->capture_default_str();
    capture.add_flag_callback(
        "--no-prefilter", [&] { capture_line.quality.prefilter = false; }, "Splats without the screen-space filter");

    CLI::App& holes =
        *app.add_subcommand("holes", "Holes, lost features and growth, from all sides; exit code 1 if any");
    add_common(holes, holes_line);
    add_quality(holes, holes_line, 26);
    holes.add_option("--directions", holes_line.quality.directions, "How many of the 26 directions around the model")
        ->check(CLI::Range(1, 26))
        ->capture_default_str();
    holes.add_option_function<std::string>(
        "--representation",
        [&](const std::string& name) { holes_line.quality.bake.cluster.representation = representation_of_name(name); },
        "hybrid (default), triangles or surfels");

    bench::FrameCommand frame_command;
    const CLI::App& frame = bench::add_frame_command(app, frame_command);

    bench::GraphCommand graph_command;
    const CLI::App& graph = bench::add_graph_command(app, graph_command);

    bench::QualityCommand quality_command;
    quality_command.folder = default_folder();
    const CLI::App& quality = bench::add_quality_command(app, quality_command);

    bench::ConfettiCommand confetti_command;
    confetti_command.folder = default_folder();
    const CLI::App& confetti = bench::add_confetti_command(app, confetti_command);

    bench::CloudCommand cloud_command;
    const CLI::App& cloud = bench::add_cloud_command(app, cloud_command);

    bench::CostsCommand costs_command;
    const CLI::App& costs = bench::add_costs_command(app, costs_command);

    bench::LevelsCommand levels_command;
    const CLI::App& levels = bench::add_levels_command(app, levels_command);

    if (!parse_command_line(app, argc, argv)) return 0;
    if (levels.parsed()) {
        bench::run_levels_command(levels_command);
        return 0;
    }
    if (costs.parsed()) {
        bench::run_costs_command(costs_command);
        return 0;
    }
    if (cloud.parsed()) {
        bench::run_cloud_command(cloud_command);
        return 0;
    }
    if (confetti.parsed()) {
        bench::run_confetti_command(confetti_command);
        return 0;
    }
    if (quality.parsed()) {
        bench::run_quality_command(quality_command);
        return 0;
    }
    if (frame.parsed()) {
        bench::run_frame_command(frame_command);
        return 0;
    }
    if (graph.parsed()) {
        bench::run_graph_command(graph_command);
        return 0;
    }

    nlohmann::json report;
    fs::path report_file;
    bool clean = true;
    if (bake.parsed()) {
        report_file = line.json;
        const auto models = bench::bench_models(line.files, line.folder);
        check_files(models, report_file);
        report = bench::bench_bake(models, line.bake);
    } else {
        CommandLine& chosen = capture.parsed() ? capture_line : holes_line;
        std::tie(chosen.quality.width, chosen.quality.height) = parse_size(chosen.size);
        SamplingOptions& sampling = chosen.quality.bake.sampling;
        sampling.h_min = std::min(sampling.h_min, sampling.h_max);
        report_file = chosen.json;
        const auto models = bench::bench_models(chosen.files, chosen.folder);
        check_files(models, report_file);
        report = capture.parsed() ? bench::bench_capture(models, chosen.quality)
                                  : bench::bench_holes(models, chosen.quality);
        clean = report.value("clean", true);
    }
    if (!report_file.empty())
        write_text_file(report_file, report.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n");
    return clean ? 0 : kExitFailure;
}

}  // namespace

int main(int argc, char** argv) {
    return splice::run_program("splice-bench", [&] { return run(argc, argv); });
}
