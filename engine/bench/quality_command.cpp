#include "engine/bench/quality_command.h"

#include "engine/bench/bench_models.h"
#include "engine/bench/bench_view.h"
#include "engine/bench/bumpy_sphere.h"
#include "engine/bench/report_files.h"
#include "engine/bench/table.h"
#include "engine/bench/world_mesh.h"
#include "engine/capture/camera_path.h"
#include "engine/capture/picture_size.h"
#include "engine/scene/gpu_model.h"
#include "preprocess/mesh/shapes.h"
#include "preprocess/model_format/atomic_file.h"
#include "preprocess/model_format/error.h"
#include "tests/reference/comparison.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <tuple>

namespace splice::bench {
namespace {
namespace fs = std::filesystem;
using namespace splice::reference;

constexpr const char* kSphere = "bumpy-sphere";
constexpr std::uint32_t kDefaultDisks = 1'000'000, kMostDisks = 50'000'000;
constexpr std::uint64_t kSphereTriangles = 4'000'000;  // of the sphere that rays are cast at

/// What is drawn, and what rays are cast at.
struct Subject {
    std::string name;
    Scene scene;
    Camera camera;
    IndexedMesh mesh;  // world units
    bool two_sided = false;
};

struct Picked {
    std::string name;
    std::uint32_t disks = 0;  // 0: the file of this name
};

std::vector<Picked> picked(const std::vector<std::string>& subjects) {
    std::vector<Picked> all;
    for (std::size_t i = 0; i < subjects.size(); ++i) {
        if (subjects[i] != kSphere) {
            if (!fs::is_regular_file(subjects[i])) throw UsageError(subjects[i] + ": no such file");
            all.push_back({subjects[i]});
            continue;
        }
        std::uint32_t disks = kDefaultDisks;
        if (i + 1 < subjects.size() && !fs::exists(subjects[i + 1]) && subjects[i + 1] != kSphere) {
            const std::string& number = subjects[++i];
            const auto [end, error] = std::from_chars(number.data(), number.data() + number.size(), disks);
            if (error != std::errc() || end != number.data() + number.size() || disks == 0 || disks > kMostDisks)
                throw UsageError(
                    fmt::format("{}: expected a number of disks from 1 to {}, got {}", kSphere, kMostDisks, number));
        }
        all.push_back({fmt::format("{} {}", kSphere, disks), disks});
    }
    return all;
}

/// 0.15 c + 0.6 (n.l) c + 0.1 (r.v)^8 + 0.1 (1 - n.v)^3, l along the view axis.
Lighting sphere_lighting() {
    Lighting lighting;
    lighting.ambient = glm::dvec3(0.15);
    Light light;
    light.space = LightSpace::kCamera;
    light.direction = {0, 0, -1};
    light.colour = glm::dvec3(0.6);
    lighting.lights = {light};
    lighting.specular = 0.1 / 0.6;  // times the light's strength
    lighting.shininess = 8;
    lighting.highlight = HighlightModel::kPhong;
    lighting.rim = 0.1;
    lighting.rim_exponent = 3;
    return lighting;
}

Subject sphere_subject(Renderer& renderer, const Picked& what, double depth, double distance) {
    Subject subject;
    subject.name = what.name;
    subject.scene = scene_of(renderer.load(view_of(bumpy_sphere(what.disks, depth))));
    subject.scene.lighting = sphere_lighting();
    subject.camera.eye = {0, 0, distance};
    subject.camera.fov_y_degrees = 60;
    RepairReport report;
    subject.mesh = in_source_units(repair_mesh(shapes::bumpy_sphere(kSphereTriangles), {}, report, kSphere));
    return subject;
}

Subject file_subject(Renderer& renderer, const Picked& what, std::uint32_t width, std::uint32_t height) {
    Subject subject;
    subject.name = fs::path(what.name).stem().string();
    LoadedScene loaded = load_scene(what.name, renderer);
    subject.mesh = world_mesh(loaded, what.name);
    CaptureCommand camera;
    camera.size = {width, height};
    subject.camera = camera_path(camera, loaded.description, loaded.scene.bounds()).front();
    for (const Instance& instance : loaded.scene.instances)
        subject.two_sided |= (instance.model->info().flags & format::kTwoSided) != 0;
    subject.scene = std::move(loaded.scene);
    subject.scene.background.transparent = false;
    return subject;
}

/// Pixels 2 px inside the reference that the frame does not cover wholly.
std::uint64_t count_holes(const Frame& frame, const Mask& truth) {
    const Mask inside = eroded(truth, 2);
    std::uint64_t holes = 0;
    for (std::size_t i = 0; i < inside.pixels.size(); ++i)
        holes += inside.pixels[i] != 0 && frame.coverage[i] != 255 ? 1 : 0;
    return holes;
}

void save_pictures(const fs::path& folder, std::string stem, const ColourImage& image, const ColourImage& truth) {
    std::replace(stem.begin(), stem.end(), ' ', '-');
    fs::create_directories(folder);
    reference::write_png(folder / (stem + ".png"), image);
    reference::write_png(folder / (stem + "-reference.png"), truth);
    reference::write_png(folder / (stem + "-error.png"), difference(image, truth));
}

nlohmann::json number_or_null(double value) {
    return std::isfinite(value) ? nlohmann::json(value) : nlohmann::json(nullptr);
}

/// One picture held against the truth.
struct Measured {
    const Subject& subject;
    const Frame& frame;
    Agreement found;
    std::uint64_t holes;
    double merge_px;
};

std::string stem_of(const Measured& measured) {
    const std::uint32_t antialias = measured.frame.stats.antialias;
    const std::string shading = measured.frame.stats.shading == Shading::kDeferred ? "-deferred" : "";
    return measured.subject.name + shading + (antialias > 1 ? fmt::format("-antialias-{}", antialias) : "") +
           (measured.merge_px != kMergePixels ? fmt::format("-merge-{}", measured.merge_px) : "");
}

std::vector<std::string> row_of(const Measured& measured) {
    const FrameStats& stats = measured.frame.stats;
    return {measured.subject.name,
            std::string(name_of(stats.shading)),
            std::to_string(stats.antialias * stats.antialias),
            fmt::format("{}", measured.merge_px),
            fmt::format("{:.2f}", measured.found.inside_db),
            fmt::format("{:.2f}", measured.found.frame_db),
            fmt::format("{:.5f}", measured.found.iou),
            std::to_string(measured.holes),
            std::to_string(stats.surfels_drawn),
            std::string(name_of(stats.backend))};
}

nlohmann::json json_of(const Measured& measured) {
    const FrameStats& stats = measured.frame.stats;
    return {{"name", measured.subject.name},
            {"shading", name_of(stats.shading)},
            {"antialias", stats.antialias},
            {"merge_px", measured.merge_px},
            {"inside_db", number_or_null(measured.found.inside_db)},
            {"frame_db", number_or_null(measured.found.frame_db)},
            {"iou", measured.found.iou},
            {"holes", measured.holes},
            {"surfels", stats.surfels_drawn},
            {"backend", name_of(stats.backend)}};
}

CaptureSettings settings_of(const QualityCommand& command) {
    CaptureSettings settings;
    std::tie(settings.width, settings.height) = parse_size(command.size);
    const auto backend = find_named(kBackendNames, command.backend);
    if (!backend) throw UsageError("--backend: expected one of " + listed(kBackendNames) + ", got " + command.backend);
    settings.backend = *backend;
    return settings;
}

struct Mode {
    Shading shading;
    std::uint32_t antialias;
    double merge_px;
};

std::vector<Mode> modes_of(const QualityCommand& command) {
    std::vector<Mode> modes;
    for (const std::string& name : command.shading) {
        const auto shading = find_named(kShadingNames, name);
        if (!shading) throw UsageError("--shading: expected one of " + listed(kShadingNames) + ", got " + name);
        for (const std::uint32_t antialias : command.antialias)
            for (const double merge_px : command.merge)
                modes.push_back({*shading, antialias, merge_px});
    }
    return modes;
}

std::vector<Picked> thesis_models(const fs::path& folder) {
    std::vector<Picked> all;
    for (const BenchModel& model : bench_models({}, folder))
        if (model.published) all.push_back({model.path.string()});
    return all;
}

}  // namespace

CLI::App& add_quality_command(CLI::App& program, QualityCommand& command) {
    CLI::App& app =
        *program.add_subcommand("quality", "PSNR over the frame and inside, silhouettes, holes, of one picture each");
    app.add_option("SUBJECT", command.subjects,
                   "Meshes, scenes, or bumpy-sphere [N]: N disks, default 1000000; without any: the thesis's models");
    app.add_option("--models", command.folder, "Folder of the thesis's models, in its subfolder meshes")
        ->capture_default_str();
    app.add_option("--depth", command.depth, "How many of the bumpy sphere's disks lie over a point, 0.1 to 1000")
        ->check(CLI::Range(0.1, 1000.0))
        ->capture_default_str();
    app.add_option("--distance", command.distance, "Of the eye from the bumpy sphere's centre, 1.2 to 1000")
        ->check(CLI::Range(1.2, 1000.0))
        ->capture_default_str();
    app.add_option("--merge", command.merge, "As splice-capture's, 0 to 64 pixels; a list: each in turn")
        ->delimiter(',')
        ->check(CLI::Range(0.0, kMostMergePixels))
        ->capture_default_str();
    app.add_option("--size", command.size, "Pixels, WIDTHxHEIGHT")->capture_default_str();
    app.add_option("--backend", command.backend, "As splice-capture --backend")->capture_default_str();
    app.add_option("--shading", command.shading, "surfel, deferred; a list: each in turn")
        ->delimiter(',')
        ->capture_default_str();
    app.add_option("--antialias", command.antialias, "Samples along each side of a pixel, 1 to 8; a list: each in turn")
        ->delimiter(',')
        ->check(CLI::Range(1U, kMostSamplesPerSide))
        ->capture_default_str();
    app.add_option("--device", command.device, "auto, cpu, or an index of splice-capture --list-devices")
        ->capture_default_str();
    app.add_option("--pictures", command.pictures, "Write frames, references and errors to this folder");
    app.add_option("--json", command.json, "Write all figures to this file");
    return app;
}

void run_quality_command(const QualityCommand& command) {
    CaptureSettings settings = settings_of(command);
    const std::vector<Picked> subjects =
        command.subjects.empty() ? thesis_models(command.folder) : picked(command.subjects);
    const std::vector<Mode> modes = modes_of(command);
    std::vector<std::filesystem::path> files;
    for (const Picked& subject : subjects)
        if (subject.disks == 0) files.emplace_back(subject.name);
    check_report_files(files_of_scenes("SUBJECT", files), {{"--json", command.json}});
    Renderer renderer({command.device, false});
    nlohmann::json report = {{"device", renderer.device_name()},
                             {"size", {settings.width, settings.height}},
                             {"pictures", nlohmann::json::array()}};
    Table table({"PSNR, dB", "shading", "samples", "merge", "inside", "frame", "IoU", "holes", "surfels", "backend"});
    for (const Picked& what : subjects) {
        show_progress(what.name);
        const Subject subject = what.disks > 0 ? sphere_subject(renderer, what, command.depth, command.distance)
                                               : file_subject(renderer, what, settings.width, settings.height);
        settings.camera = subject.camera;
        const ReferenceScene oracle(subject.mesh);
        const Truth truth = truth_of(oracle, subject.mesh, subject.scene, subject.camera, settings.width,
                                     settings.height, subject.two_sided);
        for (const auto& [shading, antialias, merge_px] : modes) {
            settings.shading = shading;
            settings.antialias = antialias;
            settings.merge_px = merge_px;
            const Frame frame = renderer.render(subject.scene, settings);
            const Measured measured{subject, frame, compare(frame, truth), count_holes(frame, truth.coverage),
                                    merge_px};
            if (!command.pictures.empty())
                save_pictures(command.pictures, stem_of(measured), colours(frame), truth.image);
            table.add(row_of(measured));
            report["pictures"].push_back(json_of(measured));
        }
        show_progress("");
    }
    fmt::print("{}, {}x{}\n\n{}", renderer.device_name(), settings.width, settings.height, table.text());
    if (!command.json.empty())
        write_text_file(command.json, report.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n");
}

}  // namespace splice::bench
