#include "engine/passes/surfel_attribute_pass.h"

#include "shaders/deferred_attribute_frag.h"
#include "shaders/deferred_attribute_vert.h"
#include "shaders/surfel_attribute_frag.h"
#include "shaders/surfel_attribute_vert.h"

namespace splice {

SurfelAttributePass::SurfelAttributePass(gpu::Device& device, const FrameData& data)
    : primitives_(device, data),
      vertex_(device, surfel_attribute_vert, "surfel_attribute.vert"),
      fragment_(device, surfel_attribute_frag, "surfel_attribute.frag"),
      deferred_vertex_(device, deferred_attribute_vert, "deferred_attribute.vert"),
      deferred_fragment_(device, deferred_attribute_frag, "deferred_attribute.frag") {}

void SurfelAttributePass::add(graph::Graph& graph, FrameTargets& targets, const FrameSettings& settings,
                              const DrawList& draws) {
    graph::Pass pass = graph.add_pass("surfel_attribute", graph::PassKind::graphics);
    targets.accumulation =
        pass.colour_attachment(targets.accumulation, graph::Contents::clear(graph::clear_colour(0, 0, 0, 0)));
    const bool deferred = is_deferred(settings);
    if (deferred)
        targets.normals =
            pass.colour_attachment(targets.normals, graph::Contents::clear(graph::clear_colour(0, 0, 0, 0)));
    pass.depth_stencil_read(targets.depth);
    pass.record([this, &settings, &draws, deferred](const graph::PassContext& context) {
        primitives_.draw(context, settings, draws, [this, deferred] { return pipeline_options(deferred); });
    });
}

gpu::GraphicsPipelineOptions attribute_state(bool deferred) {
    gpu::GraphicsPipelineOptions options;
    options.depth_test = true;
    options.depth_compare = VK_COMPARE_OP_GREATER_OR_EQUAL;
    options.stencil_test = true;
    options.stencil_front = owned_by(kSurfelStencil);
    options.stencil_back = options.stencil_front;
    options.blends.assign(deferred ? 2 : 1, gpu::Blend::additive());
    return options;
}

gpu::GraphicsPipelineOptions SurfelAttributePass::pipeline_options(bool deferred) const {
    gpu::GraphicsPipelineOptions options = attribute_state(deferred);
    options.name = "surfel_attribute";
    options.vertex = {deferred ? &deferred_vertex_ : &vertex_, {}};
    options.fragment = {deferred ? &deferred_fragment_ : &fragment_, {}};
    return options;
}

}  // namespace splice
