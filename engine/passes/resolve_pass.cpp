#include "engine/passes/resolve_pass.h"

#include "shaders/resolve_frag.h"
#include "shaders/surfel_normalise_vert.h"

#include <array>

namespace splice {

ResolvePass::ResolvePass(gpu::Device& device, const FrameData& data)
    : device_(device),
      data_(data),
      input_layout_(device, {{0, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, VK_SHADER_STAGE_FRAGMENT_BIT, 1}}),
      layout_(device, std::array{data.layout().handle(), input_layout_.handle()}, sizeof(InstanceConstants),
              VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT),
      vertex_(device, surfel_normalise_vert, "surfel_normalise.vert"),
      fragment_(device, resolve_frag, "resolve.frag"),
      sampler_(gpu::create_sampler(device, {.filter = VK_FILTER_NEAREST,
                                            .mipmap_mode = VK_SAMPLER_MIPMAP_MODE_NEAREST,
                                            .address_mode = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE})),
      pool_(device) {}

graph::ImageHandle ResolvePass::add(graph::Graph& graph, graph::ImageHandle samples, graph::ImageHandle picture,
                                    const VkClearValue& empty) {
    graph::Pass pass = graph.add_pass("resolve", graph::PassKind::graphics);
    pass.sampled(samples);
    const graph::ImageHandle written = pass.colour_attachment(picture, graph::Contents::clear(empty));
    pass.record([this, samples](const graph::PassContext& context) { draw(context, samples); });
    return written;
}

void ResolvePass::draw(const graph::PassContext& context, graph::ImageHandle samples) {
    const std::array sets{data_.set(), input_set(context, samples)};
    vkCmdBindPipeline(context.commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipelines_.get(device_, context, [&] {
        gpu::GraphicsPipelineOptions options;
        options.name = "resolve";
        options.vertex = {&vertex_, {}};
        options.fragment = {&fragment_, {}};
        options.layout = layout_.handle();
        options.blends = {gpu::Blend::replace()};
        return options;
    }));
    vkCmdBindDescriptorSets(context.commands, VK_PIPELINE_BIND_POINT_GRAPHICS, layout_.handle(), 0,
                            static_cast<std::uint32_t>(sets.size()), sets.data(), 0, nullptr);
    vkCmdDraw(context.commands, 3, 1, 0, 0);
}

VkDescriptorSet ResolvePass::input_set(const graph::PassContext& context, graph::ImageHandle samples) {
    if (inputs_.plan_id == context.plan_id && inputs_.set != VK_NULL_HANDLE) return inputs_.set;
    pool_.reset();  // one frame is in flight, and it is this one
    inputs_ = {context.plan_id, pool_.allocate(input_layout_)};
    gpu::DescriptorWriter(inputs_.set).sampled_image(0, context.view(samples), sampler_.get()).write(device_);
    return inputs_.set;
}

}  // namespace splice
