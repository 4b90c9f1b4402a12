#include "engine/bench/bench_quality.h"
#include "engine/bench/bench_view.h"
#include "engine/bench/table.h"
#include "tests/reference/comparison.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>

namespace splice::bench {
namespace {
using namespace splice::reference;
using nlohmann::json;

void add_counts(SurfaceReport& sum, const SurfaceReport& one) {
    sum.inside += one.inside;
    sum.holes += one.holes;
    sum.lost += one.lost;
    sum.grown += one.grown;
    sum.in_front += one.in_front;
    sum.worst_behind = std::max(sum.worst_behind, one.worst_behind);
    sum.worst_in_front = std::max(sum.worst_in_front, one.worst_in_front);
}

json to_json(const SurfaceReport& report, double iou) {
    return {{"inside", report.inside},
            {"holes", report.holes},
            {"lost", report.lost},
            {"grown", report.grown},
            {"in_front", report.in_front},
            {"worst_behind", report.worst_behind},
            {"iou", iou},
            {"worst_in_front", report.worst_in_front}};
}

}  // namespace

json bench_holes(const std::vector<BenchModel>& models, const QualityOptions& options) {
    Renderer renderer({options.device, false});
    json report = {{"device", renderer.device_name()}, {"clean", true}, {"models", json::array()}};
    Table table(
        {"pixels", "views", "inside", "holes", "lost", "grown", "in front", "worst behind", "lowest IoU", "faults in"});
    // A model takes minutes: its row is printed when it is done.
    std::vector<std::size_t> widths(9, 8);
    for (const BenchModel& model : models)
        widths[0] = std::max(widths[0], model.name.size());
    table.reserve(widths);
    fmt::print("{}, {}x{}\n\n{}", renderer.device_name(), options.width, options.height, table.last_line());
    std::fflush(stdout);
    for (const BenchModel& bench_model : models) {
        show_progress("bake " + bench_model.name);
        const IndexedMesh mesh = load_mesh(bench_model.path);
        const ReferenceScene oracle(mesh);
        const BakedModel baked = bake_for(renderer, mesh, options.bake, options.bake.cluster.representation);
        const Scene scene = scene_of(baked.on_device);
        SurfaceReport sum;
        double lowest_iou = 1;
        std::string faulty;
        json views = json::array();
        for (const NamedCamera& view : bench_cameras(scene.bounds(), options)) {
            show_progress(fmt::format("{}: {}", bench_model.name, view.name));
            CaptureSettings settings;
            settings.width = options.width;
            settings.height = options.height;
            settings.backend = Backend::kAuto;  // as splice-capture
            settings.camera = view.camera;
            settings.epsilon_scale = options.epsilon_scale;
            settings.sides = options.sides;
            const auto [found, iou, marked] =
                check_frame(renderer, scene, view_of(baked.model), oracle, mesh, settings);
            add_counts(sum, found);
            lowest_iou = std::min(lowest_iou, iou);
            json entry = to_json(found, iou);
            entry["view"] = view.name;
            views.push_back(entry);
            if (found.clean()) continue;
            faulty += (faulty.empty() ? "" : " ") + view.name;
            if (!options.pictures.empty()) {
                std::filesystem::create_directories(options.pictures);
                reference::write_png(options.pictures / (bench_model.name + "-" + view.name + "-holes.png"), marked);
            }
        }
        if (!sum.clean()) report["clean"] = false;
        show_progress("");
        table.add({bench_model.name, fmt::format("{}", views.size()), fmt::format("{}", sum.inside),
                   fmt::format("{}", sum.holes), fmt::format("{}", sum.lost), fmt::format("{}", sum.grown),
                   fmt::format("{}", sum.in_front), fmt::format("{:.2g}", sum.worst_behind / mesh.source_scale),
                   fmt::format("{:.4f}", lowest_iou), faulty});
        fmt::print("{}", table.last_line());
        std::fflush(stdout);
        report["models"].push_back({{"model", bench_model.name}, {"sum", to_json(sum, lowest_iou)}, {"views", views}});
    }
    return report;
}

}  // namespace splice::bench
