#include "engine/passes/frame.h"

#include "preprocess/model_format/error.h"

#include <algorithm>
#include <limits>

namespace splice {

FrameFormats::FrameFormats(const gpu::Device& device)
    : depth_stencil(device.depth_stencil_format()),
      accumulation(device.first_supported({VK_FORMAT_R32G32B32A32_SFLOAT, VK_FORMAT_R16G16B16A16_SFLOAT},
                                          VK_FORMAT_FEATURE_COLOR_ATTACHMENT_BLEND_BIT)) {}

FramePasses::FramePasses(gpu::Device& device, std::uint64_t most_splat_groups)
    : data(device),
      formats(device),
      triangle(device, data),
      surfel_visibility(device, data),
      surfel_attribute(device, data),
      splats(device, data, most_splat_groups),
      surfel_normalise(device, data),
      boxes(device, data),
      resolve(device, data) {}

VkFormat picture_format(View view) {
    return is_numeric(view) ? VK_FORMAT_R32_SFLOAT : VK_FORMAT_R8G8B8A8_UNORM;
}

SurfelBackend choose_backend(Backend wanted, std::optional<double> points_below, const FramePasses& passes,
                             const FrameSettings& settings) {
    const std::optional<Techniques> techniques = passes.splats.choose(wanted, settings);
    const bool by_size = techniques && techniques->small != techniques->others;
    return {techniques,
            by_size ? std::min(points_below.value_or(passes.splats.default_points_below(wanted)), kLargestPoint) : 0};
}

std::vector<BackendShare> backend_shares(const SurfelBackend& backend, const DrawList& draws) {
    std::uint64_t small = 0;
    for (const InstanceDraws& instance : draws.instances)
        for (const DrawRange& range : instance.small)
            small += range.count;
    const std::uint64_t others = draws.surfels - small;
    if (!backend.techniques) return {{Backend::kSprite, draws.surfels}};
    const Backend of_small = backend_of(backend.techniques->small), of_others = backend_of(backend.techniques->others);
    if (others == 0 && small > 0) return {{of_small, small}};
    if (small == 0) return {{of_others, others}};
    return {{of_others, others}, {of_small, small}};
}

namespace {

// Whether samples hold what triangles write, where there is nothing else: light.
bool are_triangles_samples(View view) {
    return view != View::kNormals && view != View::kAccumulation && view != View::kBoxes;
}

}  // namespace

graph::ImageHandle add_frame(graph::Graph& graph, graph::Bindings& bindings, FramePasses& passes,
                             const SurfelBackend& backend, const FrameSettings& settings, const Background& background,
                             const DrawList& draws) {
    const auto image = [&](const char* name, VkFormat format) {
        return graph.create_image(name, {.format = format, .width = settings.width, .height = settings.height});
    };
    const bool several = settings.antialias > 1;
    const auto resolved = [&](graph::ImageHandle samples) {
        const graph::ImageHandle picture =
            graph.create_image("picture", {.format = picture_format(settings.view),
                                           .width = settings.width / settings.antialias,
                                           .height = settings.height / settings.antialias});
        return passes.resolve.add(graph, samples, picture, empty_picture(settings.view, background));
    };
    if (backend.techniques) passes.splats.plan(draws, *backend.techniques, settings);
    if (several && draws.surfels == 0 && are_triangles_samples(settings.view)) {
        FrameTargets targets{.triangle_colour = image("samples", kSampleFormat),
                             .depth = image("depth", passes.formats.depth_stencil),
                             .accumulation = {},
                             .normals = {},
                             .splat_depth = {},
                             .picture = {}};
        passes.triangle.add(graph, targets, settings, draws, std::nullopt);
        return resolved(targets.triangle_colour);
    }
    FrameTargets targets{
        // Half floats suffice for colours, not for depths.
        .triangle_colour = image("triangle_colour", is_numeric(settings.view) ? VK_FORMAT_R32G32B32A32_SFLOAT
                                                                              : VK_FORMAT_R16G16B16A16_SFLOAT),
        .depth = image("depth", passes.formats.depth_stencil),
        .accumulation = image("accumulation", passes.formats.accumulation),
        .normals = {},
        .splat_depth = {},
        .picture = several ? image("samples", kSampleFormat) : image("picture", picture_format(settings.view)),
    };

    if (is_deferred(settings)) targets.normals = image("normals", passes.formats.accumulation);

    const bool composed = backend.techniques && passes.splats.composes(settings);
    passes.triangle.add(graph, targets, settings, draws,
                        composed ? std::optional(empty_picture(settings.view, background)) : std::nullopt);
    if (backend.techniques && !passes.splats.empty()) {
        const SurfelOwnership ownership = passes.splats.add(graph, bindings, targets, settings);
        if (!composed)
            passes.surfel_normalise.add(graph, targets, settings, background, ownership, draws.triangles > 0);
    } else if (!composed) {
        passes.surfel_visibility.add(graph, targets, settings, draws);
        passes.surfel_attribute.add(graph, targets, settings, draws);
        passes.surfel_normalise.add(graph, targets, settings, background, SurfelOwnership::kStencil,
                                    draws.triangles > 0);
    }
    if (settings.view == View::kBoxes) passes.boxes.add(graph, targets, settings, draws);
    return several ? resolved(targets.picture) : targets.picture;
}

}  // namespace splice
