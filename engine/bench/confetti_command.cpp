#include "engine/bench/confetti_command.h"

#include "engine/bench/report_files.h"
#include "engine/bench/table.h"
#include "engine/capture/capture.h"
#include "preprocess/build_model/build_model.h"
#include "preprocess/cloud/read_point_cloud.h"
#include "preprocess/model_format/atomic_file.h"
#include "preprocess/model_format/error.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace splice::bench {

namespace {

constexpr std::uint32_t kSide = 512;  // pixels, as published
// Tolerances, shares of the picture's area.
constexpr std::array kTolerances{0.0, 0.0002, 0.0004};

struct PublishedBuild {
    const char* model;
    unsigned points, nodes;
    double megabytes, seconds;
};
constexpr std::array<PublishedBuild, 4> kPublishedBuilds{{{"David", 2000606, 802371, 118.5, 12.7},
                                                          {"Female", 302948, 121439, 17.9, 2.97},
                                                          {"Balljoint", 137062, 54992, 8.1, 0.73},
                                                          {"Dragon", 437645, 173507, 25.8, 2.41}}};

// Seconds a frame, the normalisation milliseconds.
struct PublishedFrame {
    const char* model;
    double tolerance;  // percent
    unsigned splats;
    double select, splat, normalise_ms, total;
};
constexpr std::array<PublishedFrame, 12> kPublishedFrames{{{"David", 0, 899523, 0.187, 0.397, 0.128, 0.584},
                                                           {"David", 0.02, 185858, 0.121, 0.163, 0.121, 0.284},
                                                           {"David", 0.04, 172806, 0.115, 0.151, 0.122, 0.266},
                                                           {"Female", 0, 160344, 0.027, 0.047, 0.116, 0.075},
                                                           {"Female", 0.02, 60876, 0.023, 0.017, 0.127, 0.041},
                                                           {"Female", 0.04, 53512, 0.020, 0.015, 0.134, 0.035},
                                                           {"Balljoint", 0, 67363, 0.011, 0.014, 0.113, 0.026},
                                                           {"Balljoint", 0.02, 26356, 0.011, 0.004, 0.091, 0.019},
                                                           {"Balljoint", 0.16, 22067, 0.013, 0.003, 0.089, 0.018},
                                                           {"Dragon", 0, 221277, 0.041, 0.087, 0.124, 0.129},
                                                           {"Dragon", 0.02, 72037, 0.036, 0.033, 0.140, 0.069},
                                                           {"Dragon", 0.04, 57655, 0.031, 0.025, 0.141, 0.056}}};

std::string number(double value, int digits) {
    return fmt::format("{:.{}f}", value, digits);
}

// The points of a cloud; of a mesh, its vertices.
PointCloud points_of(const std::filesystem::path& path) {
    const SourceFile file = load_source_file(path);
    if (is_point_cloud(file)) return parse_point_cloud(file);
    const SourceMesh mesh = parse_mesh_file(file);
    PointCloud cloud;
    for (const Vec3d& position : mesh.positions)
        if (position.allFinite()) cloud.offsets.emplace_back(position.cast<float>());
    cloud.source_points = cloud.offsets.size();
    return cloud;
}

double sum_of(const FrameStats& stats, bool normalise) {
    double ms = 0;
    for (const PassTime& pass : stats.passes)
        if ((pass.name == "surfel_normalise") == normalise) ms += pass.gpu_ms;
    return ms;
}

struct Measured {
    double splats = 0, select_ms = 0, splat_ms = 0, normalise_ms = 0, total_ms = 0;
};

Measured turn_round(Renderer& renderer, const Scene& scene, CaptureSettings settings, unsigned frames) {
    Measured mean;
    for (unsigned i = 0; i <= frames; ++i) {
        settings.camera = frame_camera(scene.bounds(), {.azimuth_degrees = 360.0 * i / frames, .elevation_degrees = 10},
                                       kSide, kSide);
        const FrameStats stats = renderer.render(scene, settings).stats;
        if (i == 0) continue;  // compiles shaders
        mean.splats += static_cast<double>(stats.surfels_drawn) / frames;
        mean.select_ms += (stats.cut.select_ms + stats.cut.gather_ms) / frames;
        mean.splat_ms += sum_of(stats, false) / frames;
        mean.normalise_ms += sum_of(stats, true) / frames;
        mean.total_ms += stats.frame_ms / frames;
    }
    return mean;
}

class Bench {
  public:
    explicit Bench(const ConfettiCommand& command) : command_(command), renderer_({.device = command.device}) {
        report_["device"] = renderer_.device_name();
        for (const PublishedBuild& each : kPublishedBuilds)
            builds_.add({std::string(each.model) + " (published)", std::to_string(each.points),
                         std::to_string(each.nodes), number(each.megabytes, 1),
                         number(1e6 * each.megabytes / each.points, 1), number(each.seconds, 2), "-"});
        for (const PublishedFrame& each : kPublishedFrames)
            frames_.add({std::string(each.model) + " (published)", number(each.tolerance, 2),
                         std::to_string(each.splats), number(1e3 * each.select, 1), number(1e3 * each.splat, 1),
                         number(each.normalise_ms, 2), number(1e3 * each.total, 1)});
    }

    void measure(const std::filesystem::path& path) {
        BakeStats stats;
        const Model model = build_cloud_model(points_of(path), {}, stats);
        const std::string name = path.stem().stem().string();
        const double megabytes = 1e-6 * static_cast<double>(serialise_model(view_of(model)).size());
        const auto points = static_cast<double>(view_of(model).surfel_count());
        builds_.add({name, std::to_string(view_of(model).surfel_count()), std::to_string(model.point_tree.size()),
                     number(megabytes, 1), number(1e6 * megabytes / points, 1), number(stats.seconds_assemble, 2),
                     number(stats.seconds_total, 2)});
        report_["builds"].push_back({{"model", name},
                                     {"points", view_of(model).surfel_count()},
                                     {"nodes", model.point_tree.size()},
                                     {"megabytes", megabytes},
                                     {"seconds_octree", stats.seconds_assemble},
                                     {"seconds", stats.seconds_total}});
        const Scene scene = scene_of(renderer_.load(view_of(model)));
        CaptureSettings settings;
        settings.width = settings.height = kSide;
        settings.backend = Backend::kAuto;
        settings.kernel = parse_kernel(command_.kernel).value();
        for (const double tolerance : kTolerances) {
            // The half length of the circle of that area.
            settings.tau = 2 * kSide * std::sqrt(tolerance / std::numbers::pi);
            const Measured mean = turn_round(renderer_, scene, settings, command_.frames);
            frames_.add({name, number(100 * tolerance, 2), number(mean.splats, 0), number(mean.select_ms, 1),
                         number(mean.splat_ms, 1), number(mean.normalise_ms, 2), number(mean.total_ms, 1)});
            report_["frames"].push_back({{"model", name},
                                         {"tolerance_percent", 100 * tolerance},
                                         {"tau", settings.tau},
                                         {"splats", mean.splats},
                                         {"select_ms", mean.select_ms},
                                         {"splat_ms", mean.splat_ms},
                                         {"normalise_ms", mean.normalise_ms},
                                         {"total_ms", mean.total_ms}});
        }
    }

    const nlohmann::json& report() const { return report_; }
    std::string text() const {
        return fmt::format("{}, {}x{}, kernel {}, {} frames of a turn\n\nTable 1: hierarchies\n{}\nTable 2: frames\n{}",
                           renderer_.device_name(), kSide, kSide, command_.kernel, command_.frames, builds_.text(),
                           frames_.text());
    }

  private:
    const ConfettiCommand& command_;
    Renderer renderer_;
    nlohmann::json report_{{"builds", nlohmann::json::array()}, {"frames", nlohmann::json::array()}};
    Table builds_{{"model", "points", "nodes", "MB", "bytes/point", "octree s", "with normals and disks s"}};
    Table frames_{{"model", "tolerance %", "splats", "LOD ms", "splatting ms", "normalisation ms", "total ms"}};
};

}  // namespace

const CLI::App& add_confetti_command(CLI::App& app, ConfettiCommand& command) {
    CLI::App& confetti =
        *app.add_subcommand("confetti", "Tables 1 and 2 of Pajarola et al. 2004: hierarchies and frames by tolerance");
    confetti.add_option("FILE", command.files,
                        "Point clouds, or meshes whose vertices are taken; without any: the dragon, a lion, a tile of "
                        "lidar and a small bust, those that are found");
    confetti.add_option("--models", command.folder, "Folder of the models (or $SPLICE_MODELS)")->capture_default_str();
    confetti.add_option("--json", command.json, "Write all figures to this file");
    confetti.add_option("--device", command.device, "auto, cpu, or an index of splice-capture --list-devices")
        ->capture_default_str();
    confetti.add_option("--kernel", command.kernel, "As splice-capture's")->capture_default_str();
    confetti.add_option("--frames", command.frames, "Of a turn round each model; published: 1,000 of one degree")
        ->check(CLI::Range(1, 100000))
        ->capture_default_str();
    return confetti;
}

void run_confetti_command(const ConfettiCommand& command) {
    if (!parse_kernel(command.kernel)) throw UsageError("--kernel: no such kernel: \"" + command.kernel + "\"");
    std::vector<std::filesystem::path> files = command.files;
    if (files.empty())
        for (const char* name : {"meshes/dragon_vrip.ply.gz", "pointclouds/lion_takanawa_normals.ply.gz",
                                 "pointclouds/autzen_trim.las", "meshes/igea.ply"})
            if (std::filesystem::exists(command.folder / name)) files.push_back(command.folder / name);
    if (files.empty()) throw UsageError("no model in " + command.folder.string() + "; name files or use --models");
    check_report_files(named_files("FILE", files), {{"--json", command.json}});
    Bench bench(command);
    for (const std::filesystem::path& file : files)
        bench.measure(file);
    fmt::print("{}", bench.text());
    if (!command.json.empty())
        write_text_file(command.json,
                        bench.report().dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n");
}

}  // namespace splice::bench
