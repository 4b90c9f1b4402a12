#include "engine/capture/calibrate.h"

#include "preprocess/build_model/build_model.h"
#include "preprocess/mesh/read_mesh.h"
#include "preprocess/mesh/shapes.h"

#include <algorithm>
#include <array>

namespace splice {

namespace {

constexpr int kRounds = 5;
// One whose triangles are larger than a pixel, from near, and one whose are smaller.
constexpr std::array<std::uint64_t, 2> kTriangles{4'000, 40'000};
constexpr std::array<double, 2> kZooms{1, 0.25};
constexpr std::array<std::uint32_t, 2> kSides{192, 512};  // pixels

std::shared_ptr<const GpuModel> sphere(Renderer& renderer, std::uint64_t triangles, ForcedRepresentation drawn_as) {
    RepairReport report;
    BakeStats stats;
    BakeOptions options;
    options.cluster.representation = drawn_as;
    const IndexedMesh mesh = repair_mesh(shapes::bumpy_sphere(triangles), options.repair, report, "bumpy sphere");
    const Model model = build_model(mesh, options, stats);
    return renderer.load(view_of(model));
}

struct Variant {
    Scene scene;
    CaptureSettings settings;
    DrawLoad load = {};
    std::vector<double> ms = {};
};

}  // namespace

Calibration calibrate(Renderer& renderer, Backend backend) {
    std::vector<Variant> variants;
    CaptureSettings settings;
    settings.backend = backend;
    for (const ForcedRepresentation drawn_as : {ForcedRepresentation::kTriangles, ForcedRepresentation::kSurfels})
        for (const std::uint64_t triangles : kTriangles) {
            const Scene scene = scene_of(sphere(renderer, triangles, drawn_as));
            for (const Sides sides : {Sides::kOneSided, Sides::kTwoSided})
                for (const std::uint32_t side : kSides)
                    for (const double zoom : kZooms) {
                        settings.width = settings.height = side;
                        settings.sides = sides;
                        settings.camera = frame_camera(scene.bounds(), {.zoom = zoom}, side, side);
                        variants.push_back({scene, settings});
                    }
        }
    // Nothing at all, of every size.
    for (const std::uint32_t side : kSides) {
        variants.push_back(variants.front());
        CaptureSettings& empty = variants.back().settings;
        empty.width = empty.height = side;
        empty.draw_triangles = empty.draw_surfels = false;
    }
    // In turn, so that whatever else the machine does meets all alike. The first round compiles shaders.
    for (int round = 0; round <= kRounds; ++round)
        for (Variant& variant : variants) {
            const FrameStats stats = renderer.render(variant.scene, variant.settings).stats;
            variant.load = stats.load;
            if (round > 0) variant.ms.push_back(stats.frame_ms);
        }
    Calibration calibration;
    for (Variant& variant : variants) {
        std::nth_element(variant.ms.begin(), variant.ms.begin() + kRounds / 2, variant.ms.end());
        calibration.samples.push_back({variant.load, variant.ms[kRounds / 2]});
    }
    calibration.costs = fit_costs(calibration.samples);
    return calibration;
}

}  // namespace splice
