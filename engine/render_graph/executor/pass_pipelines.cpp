#include "engine/render_graph/executor/pass_pipelines.h"

namespace splice::graph {

VkPipeline PassPipelines::get(const gpu::Device& device, const PassContext& context,
                              const std::function<gpu::GraphicsPipelineOptions()>& options) {
    gpu::GraphicsPipeline& pipeline = pipelines_[{context.render_pass, context.subpass}];
    if (!pipeline) {
        gpu::GraphicsPipelineOptions filled = options();
        filled.render_pass = context.render_pass;
        filled.subpass = context.subpass;
        filled.samples = context.samples;
        pipeline = gpu::GraphicsPipeline(device, filled);
    }
    return pipeline.handle();
}

}  // namespace splice::graph
