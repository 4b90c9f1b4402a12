#include "engine/passes/surfel_visibility_pass.h"

#include "shaders/surfel_visibility_frag.h"
#include "shaders/surfel_visibility_vert.h"

namespace splice {

SurfelVisibilityPass::SurfelVisibilityPass(gpu::Device& device, const FrameData& data)
    : primitives_(device, data),
      vertex_(device, surfel_visibility_vert, "surfel_visibility.vert"),
      fragment_(device, surfel_visibility_frag, "surfel_visibility.frag") {}

void SurfelVisibilityPass::add(graph::Graph& graph, FrameTargets& targets, const FrameSettings& settings,
                               const DrawList& draws) {
    graph::Pass pass = graph.add_pass("surfel_visibility", graph::PassKind::graphics);
    targets.depth = pass.depth_stencil_attachment(targets.depth, graph::Contents::keep());
    pass.record([this, &settings, &draws](const graph::PassContext& context) {
        primitives_.draw(context, settings, draws, [this] { return pipeline_options(); });
    });
}

gpu::GraphicsPipelineOptions visibility_state() {
    gpu::GraphicsPipelineOptions options;
    options.depth_test = true;
    options.depth_write = true;
    options.depth_compare = VK_COMPARE_OP_GREATER;
    options.stencil_test = true;
    options.stencil_front = {.failOp = VK_STENCIL_OP_KEEP,
                             .passOp = VK_STENCIL_OP_REPLACE,
                             .depthFailOp = VK_STENCIL_OP_KEEP,
                             .compareOp = VK_COMPARE_OP_ALWAYS,
                             .compareMask = 0xff,
                             .writeMask = 0xff,
                             .reference = kSurfelStencil};
    options.stencil_back = options.stencil_front;
    return options;
}

gpu::GraphicsPipelineOptions SurfelVisibilityPass::pipeline_options() const {
    gpu::GraphicsPipelineOptions options = visibility_state();
    options.name = "surfel_visibility";
    options.vertex = {&vertex_, {}};
    options.fragment = {&fragment_, {}};
    return options;
}

}  // namespace splice
