#include "engine/bench/graph/family_frame.h"

#include "engine/bench/graph/family_declaration.h"
#include "engine/passes/frame.h"
#include "engine/passes/read_back_pass.h"
#include "engine/scene/gpu_model.h"
#include "preprocess/build_model/build_model.h"
#include "preprocess/mesh/shapes.h"

#include <algorithm>
#include <map>
#include <memory>
#include <utility>

namespace splice::bench {
namespace {

constexpr uint64_t kTexelBytes = 4;  // of the picture
constexpr uint64_t kTriangles = 50'000;

void declare_view(graph::Graph& graph, FramePasses& passes, const FrameSettings& settings, const Background& background,
                  const DrawList& draws) {
    const graph::BufferHandle pixels = graph.import_buffer("pixels", {kTexelBytes * settings.width * settings.height},
                                                           {.after = graph::external::host_read()});
    graph::Bindings kept;  // sprites keep nothing from frame to frame
    const graph::ImageHandle picture = add_frame(graph, kept, passes, {}, settings, background, draws);
    add_read_back(graph, picture, pixels, settings.width, settings.height);
}

/// What the declared passes refer to.
struct EmptyFrames {
    explicit EmptyFrames(gpu::Device& device) : passes(device) {}
    const FrameSettings& settings(uint32_t width, uint32_t height) {
        FrameSettings& found = by_size[{width, height}];
        found.width = width;
        found.height = height;
        return found;
    }
    FramePasses passes;
    DrawList draws;
    Background background;
    std::map<std::pair<uint32_t, uint32_t>, FrameSettings> by_size;
};

struct SphereFrame {
    SphereFrame(gpu::Device& device, const Scene& scene, uint32_t width, uint32_t height) : passes(device) {
        settings.width = width;
        settings.height = height;
        settings.camera = frame_camera(scene.bounds(), {}, width, height);
        fit_clip_planes(settings.camera, scene.drawn_bounds());
        DrawListOptions options;
        options.max_point_size = device.features().large_points ? device.limits().pointSizeRange[1] : 0;
        draws = build_draw_list(scene, settings.camera, width, height, options);
        background = scene.background;
        passes.data.update(settings, scene.lighting);
    }
    FramePasses passes;
    FrameSettings settings;
    DrawList draws;
    Background background;
};

}  // namespace

Family frame_family(gpu::Device& device) {
    const auto frames = std::make_shared<EmptyFrames>(device);
    const auto declare = [frames](graph::Graph& graph, const FamilyOptions& options) {
        FamilyBuilder builder(graph, options);
        const uint32_t views = std::max(options.passes / kFrameViewPasses, 1U);
        for (uint32_t view = 0; view < views; ++view) {
            const graph::ImageDescription size = builder.description(VK_FORMAT_UNDEFINED);
            declare_view(graph, frames->passes, frames->settings(size.width, size.height), frames->background,
                         frames->draws);
        }
    };
    return {"frame", "views of this renderer's own frame, 5 passes each", declare};
}

DeviceWorkload frame_workload(gpu::Device& device, uint32_t width, uint32_t height) {
    RepairReport report;
    BakeStats stats;
    const Model model =
        build_model(repair_mesh(shapes::bumpy_sphere(kTriangles), {}, report, "bumpy sphere"), {}, stats);
    const auto scene = std::make_shared<const Scene>(scene_of(std::make_shared<GpuModel>(device, view_of(model))));
    const auto make = [&device, scene, width, height] {
        const auto frame = std::make_shared<SphereFrame>(device, *scene, width, height);
        return [frame, scene](graph::Graph& graph) {
            declare_view(graph, frame->passes, frame->settings, frame->background, frame->draws);
        };
    };
    return {"frame", kFrameViewPasses, width, height, make};
}

}  // namespace splice::bench
