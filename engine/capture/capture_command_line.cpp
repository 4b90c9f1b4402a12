#include "engine/capture/capture_command_line.h"

#include "engine/capture/graph_switches.h"
#include "engine/capture/picture_size.h"
#include "preprocess/build_model/program_main.h"
#include "preprocess/model_format/error.h"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>

namespace splice {

namespace {

constexpr const char* kAbout = R"(splice-capture - a picture of a hybrid model, without a window

INPUT is a model file (splice-bake), a scene file (JSON, docs/scene_format.md), a mesh (OBJ, PLY, STL, OFF, SMF) or a point
cloud (LAS, PCD, PLY, XYZ, PTS, PWN); the last two are baked in memory first. Several, but for scenes, share one picture.
Coordinates are those of the files. By default the model is framed as large as it fits.)";

constexpr const char* kExamples = R"(Examples:
  splice-capture bunny.splice -o bunny.png
  splice-capture dragon.ply -o dragon.png --size 1024x768 --azimuth 120 --elevation 10 --zoom 1.5
  splice-capture cow.splice -o cow.png --eye 0,0.2,2 --target 0,0,0 --fov 30 --background transparent
  splice-capture bunny.splice -o overlap.png --view overlap --stats overlap.json
  splice-capture part.splice -o turn.png --orbit 36        writes turn-000.png ... turn-035.png

Exit status: 0 done; 1 the input, the device or the disk failed; 2 wrong usage.)";

double parse_number(const std::string& text, const std::string& option, const std::string& expected) {
    double value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value))
        throw UsageError(option + ": expected " + expected + ", got \"" + text + "\"");
    return value;
}

glm::dvec3 parse_vector(const std::string& text, const std::string& option) {
    const std::string expected = "three numbers like 0,1.5,-2";
    glm::dvec3 vector;
    std::size_t start = 0;
    for (int axis = 0; axis < 3; ++axis) {
        const std::size_t comma = text.find(',', start);
        if ((axis < 2) != (comma != std::string::npos))
            throw UsageError(option + ": expected " + expected + ", got \"" + text + "\"");
        vector[axis] = parse_number(text.substr(start, axis < 2 ? comma - start : std::string::npos), option, expected);
        start = comma + 1;
    }
    return vector;
}

double parse_in_range(const std::string& text, const std::string& option, double least, double most,
                      const std::string& unit) {
    std::ostringstream expected;
    expected << "a number from " << least << " to " << most << unit;
    const double value = parse_number(text, option, expected.str());
    if (value < least || value > most)
        throw UsageError(option + ": expected " + expected.str() + ", got \"" + text + "\"");
    return value;
}

template <typename Value, std::size_t N>
Value parse_named(const Names<Value, N>& names, const std::string& text, const std::string& option) {
    if (const auto known = find_named(names, text)) return *known;
    throw UsageError(option + ": expected one of " + listed(names) + ", got \"" + text + "\"");
}

Background parse_background(const std::string& text) {
    Background background;
    background.transparent = text == "transparent";
    if (background.transparent) return background;
    const auto colour = parse_colour(text);
    if (!colour)
        throw UsageError(
            "--background: expected transparent, a colour like #ff8000 or one of white, black, grey, red, "
            "green, blue, sky, got \"" +
            text + "\"");
    background.colour = *colour;
    return background;
}

bool parse_switch(const std::string& text, const std::string& option) {
    if (text == "on" || text == "off") return text == "on";
    throw UsageError(option + ": expected on or off, got \"" + text + "\"");
}

std::string view_help() {
    std::string help = "What to show (default shaded):";
    for (const Named<View>& known : kViewNames)
        help += "\n  " + std::string(known.name) + " - " + std::string(known.description);
    return help;
}

// Options as typed; converted once the parser is done, so that every complaint has the same shape.
struct RawOptions {
    std::vector<std::string> inputs;
    std::string output, stats, graph, size, eye, target, up, fov, azimuth, elevation, zoom, orbit, view, backend, show,
        height, background, epsilon_scale, prefilter, antialias, shading, graph_switch, tau, budget, memory, kernel,
        points_below, merge;
    bool one_sided = false, two_sided = false;
};

void convert(const RawOptions& raw, CaptureCommand& command) {
    if (!raw.size.empty()) command.size = parse_size(raw.size);
    if (!raw.eye.empty()) command.eye = parse_vector(raw.eye, "--eye");
    if (!raw.target.empty()) command.target = parse_vector(raw.target, "--target");
    if (!raw.up.empty()) command.up = parse_vector(raw.up, "--up");
    if (!raw.fov.empty()) command.fov_degrees = parse_in_range(raw.fov, "--fov", 1, 170, " degrees");
    if (!raw.azimuth.empty()) command.azimuth_degrees = parse_number(raw.azimuth, "--azimuth", "an angle in degrees");
    if (!raw.elevation.empty())
        command.elevation_degrees = parse_in_range(raw.elevation, "--elevation", -90, 90, " degrees");
    if (!raw.zoom.empty()) command.zoom = parse_in_range(raw.zoom, "--zoom", 1e-6, 1e6, "");
    if (!raw.orbit.empty()) {
        const double frames = parse_in_range(raw.orbit, "--orbit", 1, 100000, " frames");
        if (frames != std::floor(frames))
            throw UsageError("--orbit: expected a whole number of frames, got \"" + raw.orbit + "\"");
        command.orbit = static_cast<std::uint32_t>(frames);
    }
    if (!raw.view.empty()) command.view = parse_named(kViewNames, raw.view, "--view");
    if (!raw.backend.empty()) command.backend = parse_named(kBackendNames, raw.backend, "--backend");
    if (!raw.points_below.empty())
        command.points_below = parse_in_range(raw.points_below, "--points-below", 0, kLargestPoint, " pixels");
    if (!raw.merge.empty()) command.merge_px = parse_in_range(raw.merge, "--merge", 0, kMostMergePixels, " pixels");
    if (!raw.show.empty()) command.shown = parse_named(kShownNames, raw.show, "--show");
    if (!raw.height.empty())
        command.orthographic_height = parse_in_range(raw.height, "--height", 1e-30, 1e30, " world units");
    if (!raw.background.empty()) command.background = parse_background(raw.background);
    if (!raw.kernel.empty()) {
        command.kernel = parse_kernel(raw.kernel);
        if (!command.kernel)
            throw UsageError(
                "--kernel: expected gaussian:SIGMA (0.05 to 10), confetti:A,B,N (0.01 to 100, 0.1 to 4, 0.5 to 32), "
                "constant or disk, got \"" +
                raw.kernel + "\"");
    }
    if (!raw.tau.empty()) command.tau = parse_in_range(raw.tau, "--tau", 0, kMostTau, " pixels");
    if (!raw.budget.empty()) command.budget_ms = parse_in_range(raw.budget, "--budget", 0.1, 1e6, " milliseconds");
    if (!raw.memory.empty())
        command.memory =
            static_cast<std::uint64_t>(parse_in_range(raw.memory, "--memory", 1, 1e9, " MB") * 1024 * 1024);
    if (!raw.epsilon_scale.empty())
        command.epsilon_scale = parse_in_range(raw.epsilon_scale, "--epsilon-scale", 0, 100, "");
    if (!raw.prefilter.empty()) command.prefilter = parse_switch(raw.prefilter, "--prefilter");
    if (!raw.shading.empty()) command.shading = parse_named(kShadingNames, raw.shading, "--shading");
    if (!raw.antialias.empty()) {
        const double side = parse_in_range(raw.antialias, "--antialias", 1, kMostSamplesPerSide, "");
        if (side != std::floor(side))
            throw UsageError("--antialias: expected a whole number, got \"" + raw.antialias + "\"");
        command.antialias = static_cast<std::uint32_t>(side);
    }
    if (!raw.stats.empty()) command.stats = raw.stats;
    if (!raw.graph.empty()) {
        if (!graph::export_format_of(raw.graph))
            throw UsageError("--graph: expected a file that ends in .dot, .mmd or .json, got \"" + raw.graph + "\"");
        command.graph = raw.graph;
    }
    if (!raw.graph_switch.empty()) apply_graph_switches(raw.graph_switch, command.renderer.graph);
    if (raw.one_sided && raw.two_sided) throw UsageError("--one-sided and --two-sided exclude each other");
    if (raw.one_sided) command.sides = Sides::kOneSided;
    if (raw.two_sided) command.sides = Sides::kTwoSided;
    command.inputs.assign(raw.inputs.begin(), raw.inputs.end());
    command.output = raw.output;
}

// A name that promises another format would be found out by the next program that reads the picture.
void check_picture_format(const std::filesystem::path& output) {
    std::string extension = output.extension().string();
    std::ranges::transform(extension, extension.begin(),
                           [](char c) { return static_cast<char>(std::tolower(static_cast<unsigned char>(c))); });
    for (const char* other : {".jpg", ".jpeg", ".bmp", ".tga", ".ppm", ".gif", ".tif", ".tiff", ".webp", ".exr", ".hdr",
                              ".svg", ".pdf", ".avif", ".jxl"})
        if (extension == other)
            throw UsageError("-o " + output.string() + ": pictures are PNG; expected a name that ends in .png");
}

void check_combination(const CaptureCommand& command) {
    if (command.list_devices) return;
    if (command.inputs.empty() || command.inputs.front().empty()) throw UsageError("INPUT is missing (see --help)");
    if (command.output.empty()) throw UsageError("-o OUT.png is missing (see --help)");
    check_picture_format(command.output);
    if (command.renderer.graph.pipeline_statistics && !command.stats)
        throw UsageError("--pass-statistics needs --stats, which they are written to");
    if (command.orthographic && command.fov_degrees) throw UsageError("--orthographic excludes --fov");
    if (command.eye.has_value() != command.target.has_value())
        throw UsageError("--eye and --target are given together or not at all");
    if (command.up && !command.eye) throw UsageError("--up needs --eye and --target");
    if (command.orthographic_height && !(command.orthographic && command.eye))
        throw UsageError("--height needs --orthographic, --eye and --target");
    if (command.eye && (command.azimuth_degrees || command.elevation_degrees || command.zoom))
        throw UsageError("--eye and --target exclude --azimuth, --elevation and --zoom");
}

}  // namespace

std::optional<CaptureCommand> parse_capture_command(int argc, const char* const* argv) {
    CaptureCommand command;
    RawOptions raw;
    CLI::App app(kAbout, "splice-capture");
    app.footer(kExamples);
    app.set_version_flag("--version", "splice-capture " SPLICE_VERSION);
    app.add_option("INPUT", raw.inputs,
                   "MODEL.splice, a mesh or a point cloud, or several of these; or one SCENE.json");
    app.add_option("-o,--output", raw.output, "The picture, PNG");
    app.add_option("--device", command.renderer.device,
                   "auto: a GPU if there is one, else lavapipe; cpu; or a number of --list-devices")
        ->option_text("auto|cpu|INDEX");
    app.add_flag("--list-devices", command.list_devices, "Print the Vulkan devices and exit");
    app.add_option("--size", raw.size, "Pixels, default 512x512")->option_text("WxH");
    app.add_option("--eye", raw.eye, "Where the eye is, in the file's units")->option_text("X,Y,Z");
    app.add_option("--target", raw.target, "What it looks at")->option_text("X,Y,Z");
    app.add_option("--up", raw.up, "Which way is up, default 0,1,0; looking straight down 0,0,-1")
        ->option_text("X,Y,Z");
    app.add_option("--fov", raw.fov, "Full vertical field of view in degrees, 1 to 170, default 40")
        ->option_text("DEGREES");
    app.add_option("--azimuth", raw.azimuth, "Frames the model from this side: 0 front (+z), 90 right (+x); default 30")
        ->option_text("DEGREES");
    app.add_option("--elevation", raw.elevation, "The same from above, -90 to 90, default 20")->option_text("DEGREES");
    app.add_option("--zoom", raw.zoom, "2 shows everything twice as large, default 1")->option_text("FACTOR");
    app.add_flag("--orthographic", command.orthographic, "Parallel rays");
    app.add_option("--height", raw.height,
                   "With --orthographic and --eye: what the picture is high, in the file's units")
        ->option_text("LENGTH");
    app.add_option("--orbit", raw.orbit, "N pictures around the model: OUT-000.png and so on")->option_text("N");
    app.add_option("--view", raw.view, view_help())->option_text("VIEW");
    app.add_option(
           "--backend", raw.backend,
           "What draws surfels: sprite (point sprites), raster (a triangle fitted to each, from a culled list), tile "
           "(compute shaders, by screen tile), point (compute shaders, where they are small, else as raster) or auto "
           "(default: tile on software devices; else raster, and points where they are tiny). --stats tells")
        ->option_text("auto|sprite|raster|tile|point");
    app.add_option("--points-below", raw.points_below,
                   "Patches whose splats are all at most so many pixels wide are drawn as points, 0 to 64, by every "
                   "backend but sprite")
        ->option_text("PX");
    app.add_option(
           "--show", raw.show,
           "hybrid (as baked, default), triangles (surfel patches by the triangles they were sampled from, too) "
           "or surfels (surfel patches alone)")
        ->option_text("hybrid|triangles|surfels");
    app.add_option("--background", raw.background, "#rrggbb, a name (white, black, grey, sky ...) or transparent")
        ->option_text("COLOUR");
    app.add_flag("--two-sided", raw.two_sided, "Show surfaces from behind, too");
    app.add_flag("--one-sided", raw.one_sided, "Leave out what faces away; default: as baked");
    app.add_option("--epsilon-scale", raw.epsilon_scale,
                   "Factor on the depth by which surfels blend, 0 to 100, default 1; thesis: 0.75 to 1.5")
        ->option_text("FACTOR");
    app.add_option("--prefilter", raw.prefilter, "EWA's screen-space low-pass filter, default on")
        ->option_text("on|off");
    app.add_option("--shading", raw.shading,
                   "Light at surfels, to first order (surfel, default), or once a pixel (deferred)")
        ->option_text("surfel|deferred");
    app.add_option("--antialias", raw.antialias,
                   "N x N samples a pixel, 1 to 8, default 1: outlines are smooth and stay in place; slower")
        ->option_text("N");
    app.add_option(
           "--kernel", raw.kernel,
           "How a splat's weight falls off from its centre; default disk: a Gaussian that ends at its rim. Published: "
           "gaussian:0.3, 0.5, 0.8; confetti:1,1.5,2, 6,1.5,3, 4,1.5,5")
        ->option_text("gaussian:SIGMA|confetti:A,B,N|constant|disk");
    app.add_option(
           "--merge", raw.merge,
           "Surfels of a patch become fewer where that moves none by more than so many pixels, 0 to 64; default "
           "0.5; 0: every surfel is drawn")
        ->option_text("PIXELS");
    app.add_option("--tau", raw.tau,
                   "Level of detail: how many pixels an ellipse may be long that stands for many surfels, 0 to 1000; "
                   "default 0, full detail")
        ->option_text("PIXELS");
    app.add_option("--budget", raw.budget,
                   "Level of detail for a frame time: the least tau, not below --tau, that a frame is predicted to "
                   "take no longer with")
        ->option_text("MS");
    app.add_flag("--calibrate", command.calibrate,
                 "Measure what drawing takes on this device, and predict and choose between triangles and surfels by "
                 "that; default: a table of software rasterisation, so that pictures repeat");
    app.add_option("--memory", raw.memory,
                   "Hold at most so many MB of surfels, 1 to 1e9; the others stay in the model file and are read as "
                   "frames need them. Default: all are held")
        ->option_text("MB");
    app.add_option("--stats", raw.stats,
                   "Write times and counts as JSON; the frame is rendered twice, the second timed")
        ->option_text("FILE");
    app.add_option(
           "--graph", raw.graph,
           "Write the frame's render graph as compiled: for Graphviz (.dot) or Mermaid (.mmd) passes in their render "
           "passes and what they hand on; as JSON (.json) the declaration, resources, barriers and reasons, too")
        ->option_text("FILE");
    app.add_option("--graph-switch", raw.graph_switch,
                   "Switches of the render graph, which change costs and never the picture: " + graph_switch_help())
        ->option_text("LIST");
    app.add_flag("--pass-statistics", command.renderer.graph.pipeline_statistics,
                 "With --stats: what each graphics pass drew (vertices, primitives, shader invocations), where the "
                 "device counts");
    app.add_flag("--validate", command.renderer.validate,
                 "Run with the Vulkan validation layers; any message fails the run");
    app.add_flag("--quiet", command.quiet, "Print nothing but errors");
    if (!parse_command_line(app, argc, argv)) return std::nullopt;
    convert(raw, command);
    check_combination(command);
    return command;
}

}  // namespace splice
