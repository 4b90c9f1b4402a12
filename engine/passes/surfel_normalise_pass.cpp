#include "engine/passes/surfel_normalise_pass.h"

#include "shaders/deferred_shade_frag.h"
#include "shaders/surfel_normalise_frag.h"
#include "shaders/surfel_normalise_vert.h"

#include <array>
#include <limits>

namespace splice {

VkClearValue empty_picture(View view, const Background& background) {
    if (is_numeric(view)) {
        const float nothing = std::numeric_limits<float>::infinity();
        return graph::clear_colour(nothing, 0, 0, 0);
    }
    const glm::vec3 colour(background.transparent ? glm::dvec3(0) : background.colour);
    return graph::clear_colour(colour.r, colour.g, colour.b, 0);
}

SurfelNormalisePass::SurfelNormalisePass(gpu::Device& device, const FrameData& data)
    : device_(device),
      data_(data),
      input_layout_(device, {{0, VK_DESCRIPTOR_TYPE_INPUT_ATTACHMENT, VK_SHADER_STAGE_FRAGMENT_BIT, 1},
                             {1, VK_DESCRIPTOR_TYPE_INPUT_ATTACHMENT, VK_SHADER_STAGE_FRAGMENT_BIT, 1},
                             {2, VK_DESCRIPTOR_TYPE_INPUT_ATTACHMENT, VK_SHADER_STAGE_FRAGMENT_BIT, 1}}),
      layout_(device, std::array{data.layout().handle(), input_layout_.handle()}, sizeof(InstanceConstants),
              VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT),
      vertex_(device, surfel_normalise_vert, "surfel_normalise.vert"),
      fragment_(device, surfel_normalise_frag, "surfel_normalise.frag"),
      deferred_fragment_(device, deferred_shade_frag, "deferred_shade.frag"),
      pool_(device) {}

void SurfelNormalisePass::add(graph::Graph& graph, FrameTargets& targets, const FrameSettings& settings,
                              const Background& background, SurfelOwnership ownership, bool triangles) {
    graph::Pass pass = graph.add_pass("surfel_normalise", graph::PassKind::graphics);
    pass.input_attachment(targets.triangle_colour);
    pass.input_attachment(targets.accumulation);
    pass.input_attachment(is_deferred(settings) ? targets.normals : targets.depth);
    pass.depth_stencil_read(targets.depth);
    targets.picture = pass.colour_attachment(
        targets.picture, graph::Contents::clear(settings.antialias > 1 ? graph::clear_colour(0, 0, 0, 0)
                                                                       : empty_picture(settings.view, background)));
    pass.record([this, targets, &settings, ownership, triangles](const graph::PassContext& context) {
        draw(context, targets, settings, ownership, triangles);
    });
}

void SurfelNormalisePass::draw(const graph::PassContext& context, const FrameTargets& targets,
                               const FrameSettings& settings, SurfelOwnership ownership, bool triangles) {
    const std::array sets{data_.set(), input_set(context, targets, is_deferred(settings))};
    for (const std::uint32_t owner : {kTriangleStencil, kSurfelStencil}) {
        if (owner == kTriangleStencil && (ownership == SurfelOwnership::kWeight || !triangles)) continue;
        vkCmdBindPipeline(context.commands, VK_PIPELINE_BIND_POINT_GRAPHICS,
                          pipelines_[{frame_variant(settings), ownership, owner, settings.antialias > 1}].get(
                              device_, context, [&] { return pipeline_options(settings, ownership, owner); }));
        vkCmdBindDescriptorSets(context.commands, VK_PIPELINE_BIND_POINT_GRAPHICS, layout_.handle(), 0,
                                static_cast<std::uint32_t>(sets.size()), sets.data(), 0, nullptr);
        vkCmdDraw(context.commands, 3, 1, 0, 0);
    }
}

VkDescriptorSet SurfelNormalisePass::input_set(const graph::PassContext& context, const FrameTargets& targets,
                                               bool deferred) {
    if (inputs_.plan_id == context.plan_id && inputs_.set != VK_NULL_HANDLE) return inputs_.set;
    pool_.reset();  // one frame is in flight, and it is this one
    inputs_ = {context.plan_id, pool_.allocate(input_layout_)};
    const VkImageView last = deferred ? context.view(targets.normals) : context.depth_view(targets.depth);
    gpu::DescriptorWriter(inputs_.set)
        .input_attachment(0, context.view(targets.triangle_colour), VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL)
        .input_attachment(1, context.view(targets.accumulation), VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL)
        .input_attachment(
            2, last,
            deferred ? VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL : VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL)
        .write(device_);
    return inputs_.set;
}

gpu::GraphicsPipelineOptions SurfelNormalisePass::pipeline_options(const FrameSettings& settings,
                                                                   SurfelOwnership ownership,
                                                                   std::uint32_t owner) const {
    gpu::GraphicsPipelineOptions options;
    options.name = "surfel_normalise";
    options.vertex = {&vertex_, {}};
    options.fragment = {is_deferred(settings) ? &deferred_fragment_ : &fragment_, frame_constants(settings)};
    options.fragment.constants[0] = owner == kSurfelStencil ? 1u : 0u;
    options.layout = layout_.handle();
    options.fragment.constants[3] = ownership == SurfelOwnership::kWeight ? 1u : 0u;
    options.fragment.constants[4] = settings.antialias > 1 ? 1u : 0u;
    options.stencil_test = ownership == SurfelOwnership::kStencil;
    options.stencil_front = owned_by(owner);
    options.stencil_back = options.stencil_front;
    options.blends = {gpu::Blend::replace()};
    return options;
}

}  // namespace splice
