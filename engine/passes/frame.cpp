#include "engine/passes/frame.h"

#include "preprocess/model_format/error.h"

#include <limits>

namespace splice {

FrameFormats::FrameFormats(const gpu::Device& device)
    : depth_stencil(device.depth_stencil_format()),
      accumulation(device.first_supported({VK_FORMAT_R32G32B32A32_SFLOAT, VK_FORMAT_R16G16B16A16_SFLOAT},
                                          VK_FORMAT_FEATURE_COLOR_ATTACHMENT_BLEND_BIT)) {}

FramePasses::FramePasses(gpu::Device& device)
    : data(device),
      formats(device),
      triangle(device, data),
      surfel_visibility(device, data),
      surfel_attribute(device, data),
      tile(device, data),
      surfel_normalise(device, data),
      resolve(device, data) {}

VkFormat picture_format(View view) {
    return is_numeric(view) ? VK_FORMAT_R32_SFLOAT : VK_FORMAT_R8G8B8A8_UNORM;
}

Backend choose_backend(Backend wanted, const gpu::Device& device, const FramePasses& passes,
                       const FrameSettings& settings, const DrawList& draws) {
    const bool tiles = wanted == Backend::kTile || (wanted == Backend::kAuto && device.info().is_cpu());
    return tiles && passes.tile.can_draw(settings, draws) ? Backend::kTile : Backend::kSprite;
}

graph::ImageHandle add_frame(graph::Graph& graph, graph::Bindings& bindings, FramePasses& passes, Backend backend,
                             const FrameSettings& settings, const Background& background, const DrawList& draws) {
    const auto image = [&](const char* name, VkFormat format) {
        return graph.create_image(name, {.format = format, .width = settings.width, .height = settings.height});
    };
    const bool several = settings.antialias > 1;
    FrameTargets targets{
        // Half floats suffice for colours, not for depths.
        .triangle_colour = image("triangle_colour", is_numeric(settings.view) ? VK_FORMAT_R32G32B32A32_SFLOAT
                                                                              : VK_FORMAT_R16G16B16A16_SFLOAT),
        .depth = image("depth", passes.formats.depth_stencil),
        .accumulation = image("accumulation", passes.formats.accumulation),
        .normals = {},
        .picture = several ? image("samples", kSampleFormat) : image("picture", picture_format(settings.view)),
    };

    if (is_deferred(settings)) targets.normals = image("normals", passes.formats.accumulation);

    passes.triangle.add(graph, targets, settings, draws);
    if (backend == Backend::kTile) {
        passes.tile.add(graph, bindings, targets, settings, draws);
        passes.surfel_normalise.add(graph, targets, settings, background, SurfelOwnership::kWeight);
    } else {
        passes.surfel_visibility.add(graph, targets, settings, draws);
        passes.surfel_attribute.add(graph, targets, settings, draws);
        passes.surfel_normalise.add(graph, targets, settings, background, SurfelOwnership::kStencil);
    }
    if (!several) return targets.picture;
    const graph::ImageHandle picture = graph.create_image("picture", {.format = picture_format(settings.view),
                                                                      .width = settings.width / settings.antialias,
                                                                      .height = settings.height / settings.antialias});
    return passes.resolve.add(graph, targets.picture, picture, empty_picture(settings.view, background));
}

}  // namespace splice
