#include "engine/passes/raster_passes.h"

#include "engine/passes/surfel_attribute_pass.h"
#include "engine/passes/surfel_visibility_pass.h"
#include "engine/scene/gpu_model.h"
#include "shaders/deferred_attribute_frag.h"
#include "shaders/raster_attribute_vert.h"
#include "shaders/raster_deferred_vert.h"
#include "shaders/raster_visibility_vert.h"
#include "shaders/surfel_attribute_frag.h"
#include "shaders/surfel_visibility_frag.h"

#include <array>

namespace splice {

RasterPasses::RasterPasses(gpu::Device& device, const FrameData& data, const SplatBuffers& buffers)
    : device_(device),
      data_(data),
      buffers_(buffers),
      surfel_layout_(surfel_set_layout(device)),
      layout_(device, std::array{data.layout().handle(), surfel_layout_.handle(), buffers.layout().handle()},
              sizeof(InstanceConstants), VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT),
      visibility_vertex_(device, raster_visibility_vert, "raster_visibility.vert"),
      visibility_fragment_(device, surfel_visibility_frag, "surfel_visibility.frag"),
      attribute_vertex_(device, raster_attribute_vert, "raster_attribute.vert"),
      attribute_fragment_(device, surfel_attribute_frag, "surfel_attribute.frag"),
      deferred_vertex_(device, raster_deferred_vert, "raster_deferred.vert"),
      deferred_fragment_(device, deferred_attribute_frag, "deferred_attribute.frag") {}

void RasterPasses::read_splats(graph::Pass& pass, const SplatHandles& handles) {
    pass.storage_read(handles.records, VK_PIPELINE_STAGE_VERTEX_SHADER_BIT);
    pass.storage_read(handles.list, VK_PIPELINE_STAGE_VERTEX_SHADER_BIT);
    pass.indirect_buffer(handles.list);
}

void RasterPasses::add_visibility(graph::Graph& graph, FrameTargets& targets, const FrameSettings& settings,
                                  const SplatHandles& handles) {
    graph::Pass pass = graph.add_pass("raster_visibility", graph::PassKind::graphics);
    read_splats(pass, handles);
    targets.depth = pass.depth_stencil_attachment(targets.depth, graph::Contents::keep());
    pass.record([this, &settings](const graph::PassContext& context) { draw(context, settings, false); });
}

void RasterPasses::add_attributes(graph::Graph& graph, FrameTargets& targets, const FrameSettings& settings,
                                  const SplatHandles& handles, bool fresh) {
    graph::Pass pass = graph.add_pass("raster_attributes", graph::PassKind::graphics);
    read_splats(pass, handles);
    const graph::Contents before =
        fresh ? graph::Contents::clear(graph::clear_colour(0, 0, 0, 0)) : graph::Contents::keep();
    targets.accumulation = pass.colour_attachment(targets.accumulation, before);
    if (is_deferred(settings)) targets.normals = pass.colour_attachment(targets.normals, before);
    pass.depth_stencil_read(targets.depth);
    pass.record([this, &settings](const graph::PassContext& context) { draw(context, settings, true); });
}

void RasterPasses::draw(const graph::PassContext& context, const FrameSettings& settings, bool attributes) {
    const VkCommandBuffer commands = context.commands;
    vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS,
                      pipelines_[{frame_variant(settings), attributes}].get(
                          device_, context, [&] { return pipeline_options(settings, attributes); }));
    const VkDescriptorSet frame_set = data_.set(), splats = buffers_.set();
    vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, layout_.handle(), 0, 1, &frame_set, 0, nullptr);
    vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, layout_.handle(), 2, 1, &splats, 0, nullptr);
    vkCmdDrawIndirect(commands, buffers_.list().handle(), kListDraw, 1, 0);
}

gpu::GraphicsPipelineOptions RasterPasses::pipeline_options(const FrameSettings& settings, bool attributes) const {
    const bool deferred = attributes && is_deferred(settings);
    gpu::GraphicsPipelineOptions options = attributes ? attribute_state(deferred) : visibility_state();
    options.name = attributes ? "raster_attributes" : "raster_visibility";
    options.vertex = {deferred     ? &deferred_vertex_
                      : attributes ? &attribute_vertex_
                                   : &visibility_vertex_,
                      frame_constants(settings)};
    options.fragment = {deferred     ? &deferred_fragment_
                        : attributes ? &attribute_fragment_
                                     : &visibility_fragment_,
                        frame_constants(settings)};
    options.layout = layout_.handle();
    return options;
}

}  // namespace splice
