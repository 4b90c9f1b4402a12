#include "engine/bench/bench_quality.h"
#include "engine/bench/bench_view.h"
#include "engine/bench/table.h"
#include "tests/reference/comparison.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace splice::bench {
namespace {
namespace fs = std::filesystem;
using namespace splice::reference;
using nlohmann::json;

struct Timing {
    double minimum, median;
    std::vector<std::pair<std::string, double>> passes;  // median GPU milliseconds
};

Timing time_frames(Renderer& renderer, const Scene& scene, const CaptureSettings& settings, int frames) {
    std::vector<double> totals;
    std::vector<std::pair<std::string, std::vector<double>>> passes;
    for (int i = 0; i < frames; ++i) {
        const FrameStats stats = renderer.render(scene, settings).stats;
        totals.push_back(stats.frame_ms);
        passes.resize(stats.passes.size());
        for (std::size_t p = 0; p < stats.passes.size(); ++p) {
            passes[p].first = stats.passes[p].name;
            passes[p].second.push_back(stats.passes[p].gpu_ms);
        }
    }
    Timing timing{*std::min_element(totals.begin(), totals.end()), median(totals), {}};
    for (auto& [name, values] : passes)
        timing.passes.emplace_back(name, median(std::move(values)));
    return timing;
}

std::string pass_list(const Timing& timing) {
    std::string text;
    for (const auto& [name, ms] : timing.passes)
        text += fmt::format("{}{} {:.1f}", text.empty() ? "" : ", ", name, ms);
    return text;
}

double mean(const std::vector<double>& values) {
    return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

void save_pictures(const fs::path& folder, const std::string& stem, const ColourImage& hybrid,
                   const ColourImage& triangles, const ColourImage& truth) {
    fs::create_directories(folder);
    reference::write_png(folder / (stem + "-hybrid.png"), hybrid);
    reference::write_png(folder / (stem + "-triangles.png"), triangles);
    reference::write_png(folder / (stem + "-reference.png"), truth);
    reference::write_png(folder / (stem + "-hybrid-error.png"), difference(hybrid, truth));
    reference::write_png(folder / (stem + "-triangles-error.png"), difference(triangles, truth));
}

}  // namespace

json bench_capture(const std::vector<BenchModel>& models, const QualityOptions& options) {
    Renderer renderer({options.device, false});
    json report = {{"device", renderer.device_name()}, {"models", json::array()}};
    Table truth_table({"PSNR, dB", "hybrid inside", "triangles inside", "difference", "worst view", "hybrid frame",
                       "triangles frame", "IoU"});
    Table speed_table({"speed", "hybrid ms (min)", "(median)", "triangles ms (min)", "(median)", "thesis fps",
                       "surfels", "Msurfels/s", "overlap", "thesis", "passes, ms"});
    for (const BenchModel& bench_model : models) {
        show_progress("bake " + bench_model.name);
        const IndexedMesh mesh = load_mesh(bench_model.path);
        const ReferenceScene oracle(mesh);
        const BakedModel hybrid = bake_for(renderer, mesh, options.bake, ForcedRepresentation::kHybrid);
        const BakedModel triangles = bake_for(renderer, mesh, options.bake, ForcedRepresentation::kTriangles);
        const Scene hybrid_scene = scene_of(hybrid.on_device), triangle_scene = scene_of(triangles.on_device);
        const bool two_sided = (hybrid.model.info.flags & format::kTwoSided) != 0;

        std::vector<double> hybrid_inside, triangles_inside, hybrid_whole, triangles_whole, iou, differences;
        json views = json::array();
        std::string worst_view;
        for (const NamedCamera& view : bench_cameras(hybrid_scene.bounds(), options)) {
            show_progress(fmt::format("{}: {}", bench_model.name, view.name));
            CaptureSettings settings;
            settings.width = options.width;
            settings.height = options.height;
            settings.backend = Backend::kAuto;  // as splice-capture
            settings.camera = view.camera;
            settings.epsilon_scale = options.epsilon_scale;
            settings.sides = options.sides;
            settings.prefilter = options.prefilter;
            settings.antialias = options.antialias;
            settings.want_overlap = true;
            const Frame hybrid_frame = renderer.render(hybrid_scene, settings);
            const Frame triangle_frame = renderer.render(triangle_scene, settings);
            const Truth truth =
                truth_of(oracle, mesh, hybrid_scene, view.camera, options.width, options.height, two_sided);
            const Agreement h = compare(hybrid_frame, truth), t = compare(triangle_frame, truth);
            if (differences.empty() ||
                h.inside_db - t.inside_db < *std::min_element(differences.begin(), differences.end()))
                worst_view = view.name;
            hybrid_inside.push_back(h.inside_db);
            triangles_inside.push_back(t.inside_db);
            hybrid_whole.push_back(h.frame_db);
            triangles_whole.push_back(t.frame_db);
            differences.push_back(h.inside_db - t.inside_db);
            iou.push_back(h.iou);
            views.push_back({{"view", view.name},
                             {"hybrid", {{"inside_db", h.inside_db}, {"frame_db", h.frame_db}, {"iou", h.iou}}},
                             {"triangles", {{"inside_db", t.inside_db}, {"frame_db", t.frame_db}, {"iou", t.iou}}},
                             {"surfels_drawn", hybrid_frame.stats.surfels_drawn},
                             {"triangles_drawn", hybrid_frame.stats.triangles_drawn},
                             {"overlap_mean", hybrid_frame.stats.overlap_mean}});
            if (!options.pictures.empty())
                save_pictures(options.pictures, bench_model.name + "-" + view.name, colours(hybrid_frame),
                              colours(triangle_frame), truth.image);
        }

        show_progress("time " + bench_model.name);
        QualityOptions one_view = options;
        one_view.directions = 1;
        CaptureSettings settings;
        settings.width = options.width;
        settings.height = options.height;
        settings.backend = Backend::kAuto;
        settings.camera = bench_cameras(hybrid_scene.bounds(), one_view).front().camera;
        const FrameStats warm = renderer.render(hybrid_scene, settings).stats;
        const Timing hybrid_time = time_frames(renderer, hybrid_scene, settings, options.frames);
        renderer.render(triangle_scene, settings);
        const Timing triangle_time = time_frames(renderer, triangle_scene, settings, options.frames);
        const double surfel_rate = static_cast<double>(warm.surfels_drawn) / (hybrid_time.median * 1e-3);

        const auto& published = bench_model.published;
        truth_table.add(
            {bench_model.name, fmt::format("{:.2f}", mean(hybrid_inside)),
             fmt::format("{:.2f}", mean(triangles_inside)), fmt::format("{:+.2f}", mean(differences)),
             fmt::format("{:+.2f} {}", *std::min_element(differences.begin(), differences.end()), worst_view),
             fmt::format("{:.2f}", mean(hybrid_whole)), fmt::format("{:.2f}", mean(triangles_whole)),
             fmt::format("{:.4f}", mean(iou))});
        speed_table.add(
            {bench_model.name, fmt::format("{:.1f}", hybrid_time.minimum), fmt::format("{:.1f}", hybrid_time.median),
             fmt::format("{:.1f}", triangle_time.minimum), fmt::format("{:.1f}", triangle_time.median),
             published ? fmt::format("{:.0f} / {:.0f}", published->hybrid_fps, published->triangle_fps) : "",
             fmt::format("{}", warm.surfels_drawn), fmt::format("{:.2f}", surfel_rate * 1e-6),
             fmt::format("{:.1f}", views.front()["overlap_mean"].get<double>()),
             published ? fmt::format("{:.1f}", published->surfels_per_pixel) : "", pass_list(hybrid_time)});
        json passes = json::array();
        for (const auto& [name, ms] : hybrid_time.passes)
            passes.push_back({{"name", name}, {"gpu_ms", ms}});
        report["models"].push_back(
            {{"model", bench_model.name},
             {"views", views},
             {"hybrid_ms", {{"min", hybrid_time.minimum}, {"median", hybrid_time.median}}},
             {"triangles_ms", {{"min", triangle_time.minimum}, {"median", triangle_time.median}}},
             {"surfels_per_second", surfel_rate},
             {"passes", passes}});
    }
    show_progress("");
    fmt::print("{}, {}x{}\n\n{}\n{}", renderer.device_name(), options.width, options.height, truth_table.text(),
               speed_table.text());
    return report;
}

}  // namespace splice::bench
