#include "engine/render_graph/executor/pass_pipelines.h"

namespace splice::graph {

VkPipeline PassPipelines::get(const gpu::Device& device, const PassContext& context,
                              const std::function<gpu::GraphicsPipelineOptions()>& options) {
    // Most routines have but one, which no search and no reference count is needed for.
    const auto first = pipelines_.begin();
    if (first != pipelines_.end() && same(first->first, context)) return first->second.handle();
    const Place place{*context.render_pass_owner, context.subpass};
    if (const auto known = pipelines_.find(place); known != pipelines_.end()) return known->second.handle();
    std::erase_if(pipelines_, [](const auto& entry) { return entry.first.render_pass.expired(); });
    gpu::GraphicsPipelineOptions filled = options();
    filled.render_pass = context.render_pass;
    filled.subpass = context.subpass;
    filled.samples = context.samples;
    return pipelines_.emplace(place, gpu::GraphicsPipeline(device, filled)).first->second.handle();
}

}  // namespace splice::graph
