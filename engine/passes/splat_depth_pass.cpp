#include "engine/passes/splat_depth_pass.h"

#include "engine/passes/surfel_visibility_pass.h"
#include "shaders/splat_depth_frag.h"
#include "shaders/surfel_normalise_vert.h"

#include <array>

namespace splice {

SplatDepthPass::SplatDepthPass(gpu::Device& device, const FrameData& data)
    : device_(device),
      input_layout_(device, {{0, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, VK_SHADER_STAGE_FRAGMENT_BIT}}),
      layout_(device, std::array{data.layout().handle(), input_layout_.handle()}),
      vertex_(device, surfel_normalise_vert, "surfel_normalise.vert"),
      fragment_(device, splat_depth_frag, "splat_depth.frag"),
      sampler_(gpu::create_sampler(device, {.filter = VK_FILTER_NEAREST,
                                            .mipmap_mode = VK_SAMPLER_MIPMAP_MODE_NEAREST,
                                            .address_mode = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE})),
      pool_(device) {}

void SplatDepthPass::add(graph::Graph& graph, FrameTargets& targets) {
    graph::Pass pass = graph.add_pass("splat_depth", graph::PassKind::graphics);
    pass.sampled(targets.splat_depth);
    targets.depth = pass.depth_stencil_attachment(targets.depth, graph::Contents::keep());
    pass.record([this, image = targets.splat_depth](const graph::PassContext& context) { draw(context, image); });
}

void SplatDepthPass::draw(const graph::PassContext& context, graph::ImageHandle splat_depth) {
    if (plan_id_ != context.plan_id || set_ == VK_NULL_HANDLE) {
        pool_.reset();  // one frame is in flight, and it is this one
        set_ = pool_.allocate(input_layout_);
        plan_id_ = context.plan_id;
        gpu::DescriptorWriter(set_).sampled_image(0, context.view(splat_depth), sampler_.get()).write(device_);
    }
    vkCmdBindPipeline(context.commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipelines_.get(device_, context, [&] {
        gpu::GraphicsPipelineOptions options = visibility_state();
        options.name = "splat_depth";
        options.vertex = {&vertex_, {}};
        options.fragment = {&fragment_, {}};
        options.layout = layout_.handle();
        return options;
    }));
    vkCmdBindDescriptorSets(context.commands, VK_PIPELINE_BIND_POINT_GRAPHICS, layout_.handle(), 1, 1, &set_, 0,
                            nullptr);
    vkCmdDraw(context.commands, 3, 1, 0, 0);
}

}  // namespace splice
