#include "preprocess/build_model/bake_command_line.h"

#include "preprocess/build_model/distinct_files.h"
#include "preprocess/build_model/program_main.h"
#include "preprocess/model_format/compressed_model.h"
#include "preprocess/model_format/error.h"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <sstream>
#include <string>

namespace splice {
namespace {

namespace fs = std::filesystem;

std::optional<double> parse_number(const std::string& text) {
    double value = 0;
    const char* begin = text.c_str() + (text.starts_with('+') ? 1 : 0);
    const char* end = text.c_str() + text.size();
    const auto [rest, error] = std::from_chars(begin, end, value);
    if (error != std::errc() || rest != end || !std::isfinite(value)) return std::nullopt;
    return value;
}

std::string printed(double value) {
    std::ostringstream text;
    text << value;
    return text.str();
}

// CLI::Range lets NaN through.
CLI::Validator number_between(double least, double most) {
    const auto check = [least, most](std::string& text) -> std::string {
        const std::optional<double> value = parse_number(text);
        if (value && *value >= least && *value <= most) return {};
        return "'" + text + "' is not a number from " + printed(least) + " to " + printed(most);
    };
    return {check, "", "number"};
}

CLI::Validator integer_between(int least, int most) {
    const auto check = [least, most](std::string& text) -> std::string {
        const std::optional<double> value = parse_number(text);
        if (value && *value >= least && *value <= most && *value == std::floor(*value)) return {};
        return "'" + text + "' is not a whole number from " + std::to_string(least) + " to " + std::to_string(most);
    };
    return {check, "", "integer"};
}

CLI::Validator any_number() {
    const auto check = [](std::string& text) -> std::string {
        return parse_number(text) ? std::string() : "'" + text + "' is not a finite number";
    };
    return {check, "", "number"};
}

template <typename Enum>
CLI::Option* add_choice(CLI::App& app, const std::string& name, Enum& value, const std::map<std::string, Enum>& choices,
                        const std::string& help) {
    const auto assign = [&value, &choices, name](const std::string& text) {
        const auto found = choices.find(text);
        if (found == choices.end()) {
            std::string known;
            for (const auto& [choice, ignored] : choices)
                known += (known.empty() ? "" : "|") + choice;
            throw CLI::ValidationError(name, "'" + text + "' is none of " + known);
        }
        value = found->second;
    };
    return app.add_option_function<std::string>(name, assign, help);
}

// bunny.ply.gz -> bunny.splice, in the current folder.
fs::path default_output(const fs::path& input) {
    fs::path name = input.filename();
    if (name.extension() == ".gz") name.replace_extension();
    return name.replace_extension(".splice");
}

void check_consistency(const BakeCommand& command) {
    check_files(command);
    const SamplingOptions& sampling = command.options.sampling;
    if (sampling.h_min > sampling.h_max)
        throw UsageError("--h-min " + printed(sampling.h_min) + " is larger than --h-max " + printed(sampling.h_max));
    const ClusterOptions& cluster = command.options.cluster;
    if (cluster.triangle_share && cluster.representation != ForcedRepresentation::kHybrid)
        throw UsageError("--triangle-share needs --representation hybrid");
}

constexpr const char* kFooter = R"(Examples:
  splice-bake bunny.obj                          writes bunny.splice
  splice-bake scan.ply.gz -o scan.splice --stats scan.json
  splice-bake part.stl --representation triangles
  splice-bake tile.las --neighbours 24           a noisy point cloud
  splice-bake cow.smf --selection thesis --sampling 4     as published

Lengths are shares of the longest side of the model's bounding box, areas shares of the surface's area.
Exit code: 0 done, 1 input or system failed, 2 wrong usage. A failed or killed bake leaves no output behind.)";

}  // namespace

void check_files(const BakeCommand& command, const std::vector<fs::path>& companions) {
    std::vector<NamedFile> inputs = {{"INPUT", command.input}}, outputs = {{"--output", command.output}};
    for (const fs::path& companion : companions)
        inputs.push_back({"INPUT's material or texture", companion});
    if (command.stats) outputs.push_back({"--stats", *command.stats});
    check_distinct_files(inputs, outputs);
}

std::optional<BakeCommand> parse_bake_command(int argc, const char* const* argv) {
    static const std::map<std::string, Selection> selections = {{"geometric", Selection::kGeometric},
                                                                {"thesis", Selection::kThesis}};
    static const std::map<std::string, ForcedRepresentation> representations = {
        {"hybrid", ForcedRepresentation::kHybrid},
        {"triangles", ForcedRepresentation::kTriangles},
        {"surfels", ForcedRepresentation::kSurfels}};
    BakeCommand command;
    BakeOptions& options = command.options;
    std::string sampling = "adaptive";
    bool no_prune = false;
    std::string output, stats;

    CLI::App app{
        "Bakes a mesh into a hybrid model: triangle patches where the surface is flat, surfels where it varies; or a "
        "point cloud into a model of surfels.",
        "splice-bake"};
    app.footer(kFooter);
    app.add_option("INPUT", command.input,
                   "Mesh: OBJ, PLY, STL, OFF or SMF; point cloud: LAS, PCD, PLY, XYZ, PTS or PWN; also gzipped (.gz)")
        ->required();
    app.add_option("-o,--output", output,
                   "Model file to write; default: INPUT's name with .splice, in the current folder")
        ->type_name("MODEL.splice");
    app.set_version_flag("--version", "splice-bake " SPLICE_VERSION);

    const std::string choice = "Which part becomes surfels";
    add_choice(app, "--representation", options.cluster.representation, representations,
               "hybrid (default), or all of it as triangles or surfels")
        ->type_name("hybrid|triangles|surfels")
        ->group(choice);
    add_choice(app, "--selection", options.cluster.selection, selections,
               "geometric (default): by how rough a patch is; thesis: the published two-phase cost")
        ->type_name("geometric|thesis")
        ->group(choice);
    app.add_option("--triangle-share", options.cluster.triangle_share,
                   "Share of the input's triangles to keep as triangles, 0..1; default: as the selection finds")
        ->check(number_between(0, 1))
        ->type_name("SHARE")
        ->group(choice);
    app.add_option("--phase1-cost", options.cluster.phase1_cost,
                   "Clusters merge in phase one while the cost (no unit) is at most this; larger merges more; default: "
                   "geometric no limit, thesis 0.1625")
        ->check(any_number())
        ->type_name("COST")
        ->group(choice);
    app.add_option("--phase2-cost", options.cluster.phase2_cost,
                   "The same for phase two, which makes the surfel patches; default: geometric 0.9, thesis 1.8")
        ->check(any_number())
        ->type_name("COST")
        ->group(choice);
    app.add_option(
           "--max-patch-area", options.cluster.max_patch_area,
           "Largest patch, share of the surface's area, 1e-9..1; default: geometric 0.002 but at least 16 median "
           "triangles, thesis 5.69 median triangles")
        ->check(number_between(1e-9, 1))
        ->type_name("SHARE")
        ->group(choice);

    const std::string surfels = "Surfels";
    app.add_option("--sampling", sampling,
                   "adaptive (default): spacing follows curvature and colour detail; a number C, 0.1..64: the thesis's "
                   "spacing, a patch's mean edge length / C")
        ->type_name("adaptive|C")
        ->group(surfels);
    app.add_option("--h-min", options.sampling.h_min,
                   "Least spacing, share of the model's longest side, 1e-5..1; default 1/" +
                       printed(std::round(1 / options.sampling.h_min)))
        ->check(number_between(1e-5, 1))
        ->type_name("LENGTH")
        ->group(surfels);
    app.add_option("--h-max", options.sampling.h_max,
                   "Largest spacing, share of the model's longest side, 1e-5..1; default 1/" +
                       printed(std::round(1 / options.sampling.h_max)))
        ->check(number_between(1e-5, 1))
        ->type_name("LENGTH")
        ->group(surfels);
    app.add_option("--sagitta", options.sampling.sagitta,
                   "How far the surface may bend away within a spacing, share of the model's longest side, 1e-7..1: "
                   "four times as much doubles the spacing on curved surfaces; default 1/" +
                       printed(std::round(1 / options.sampling.sagitta)))
        ->check(number_between(1e-7, 1))
        ->type_name("LENGTH")
        ->group(surfels);
    app.add_option("--crease-spacing", options.sampling.crease_spacing,
                   "Spacing at creases and borders, share of the model's longest side, 1e-5..1; default 1/" +
                       printed(std::round(1 / options.sampling.crease_spacing)))
        ->check(number_between(1e-5, 1))
        ->type_name("LENGTH")
        ->group(surfels);
    app.add_flag("--no-prune", no_prune,
                 "Keep surfels that others cover (--sampling C; adaptive sampling makes none) and do not shrink disks")
        ->group(surfels);

    app.add_option(
           "--neighbours", options.cloud.neighbours,
           "Nearest neighbours that define the plane of a point without a normal, 6..64; more smooth out noise, "
           "and small features with it; default " +
               std::to_string(kUsualNeighbours) + ", or " + std::to_string(kNoisyNeighbours) +
               " if noise is as wide as the spacing")
        ->check(integer_between(6, 64))
        ->type_name("COUNT")
        ->group("Point clouds");

    const std::string other = "Other";
    app.add_option("--crease-angle", options.repair.crease_angle_degrees,
                   "Missing normals are split where faces meet at more than this, degrees, 0..180; default " +
                       printed(static_cast<double>(options.repair.crease_angle_degrees)))
        ->check(number_between(0, 180))
        ->type_name("DEGREES")
        ->group(other);
    app.add_option("--lod-levels", options.simplify.levels,
                   "Triangle levels of detail a patch, the finest included, 1..16; default " +
                       std::to_string(options.simplify.levels))
        ->check(integer_between(1, 16))
        ->type_name("COUNT")
        ->group(other);
    app.add_option("--threads", options.threads,
                   "Threads, 0..1024; 0 (default): one a core. The output does not depend on it")
        ->check(integer_between(0, 1024))
        ->type_name("COUNT")
        ->group(other);
    app.add_option("--stats", stats, "Write counts, times (seconds) and peak memory (bytes) as JSON")
        ->type_name("FILE")
        ->group(other);
    app.add_flag("--compress", command.compress,
                 "Write a compressed file, a third to a half smaller; programs then hold all of it in memory")
        ->group(other);
    app.add_flag("--quiet", command.quiet, "Print errors only")->group(other);

    if (!parse_command_line(app, argc, argv)) return std::nullopt;
    if (command.input.empty()) throw UsageError("INPUT is an empty name (see --help)");
    if (app.count("--output") != 0 && output.empty()) throw UsageError("--output: an empty name (see --help)");
    if (app.count("--stats") != 0 && stats.empty()) throw UsageError("--stats: an empty name (see --help)");

    command.output = output.empty() ? default_output(command.input) : fs::path(output);
    if (app.count("--stats") != 0) command.stats = stats;
    options.sampling.prune = !no_prune;
    if (sampling != "adaptive") {
        options.sampling.thesis_c = parse_number(sampling);
        if (!options.sampling.thesis_c || *options.sampling.thesis_c < 0.1 || *options.sampling.thesis_c > 64)
            throw UsageError("--sampling: '" + sampling +
                             "' is neither adaptive nor a number from 0.1 to 64 (see --help)");
    }
    // One limit alone carries the other's default along.
    if (app.count("--h-max") == 0) options.sampling.h_max = std::max(options.sampling.h_max, options.sampling.h_min);
    if (app.count("--h-min") == 0) options.sampling.h_min = std::min(options.sampling.h_min, options.sampling.h_max);
    if (command.compress && !can_compress_models()) throw UsageError("--compress: this program was built without zstd");
    check_consistency(command);
    return command;
}

}  // namespace splice
