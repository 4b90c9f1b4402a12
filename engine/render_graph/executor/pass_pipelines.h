// The graphics pipelines of a drawing routine, by where in a render pass it is recorded.
#pragma once

#include "engine/render_graph/executor/pass_context.h"
#include "engine/vulkan/device.h"
#include "engine/vulkan/pipeline.h"

#include <vulkan/vulkan_core.h>

#include <cstdint>
#include <functional>
#include <map>
#include <utility>

namespace splice::graph {

/// One pipeline for each subpass that the routine is recorded in. Serves one executor, which must not be replaced by
/// another within its life: render passes are told apart by their handles.
class PassPipelines {
  public:
    /// `options` is called when (render pass, subpass) is new; render_pass, subpass and samples are filled in here.
    VkPipeline get(const gpu::Device& device, const PassContext& context,
                   const std::function<gpu::GraphicsPipelineOptions()>& options);

  private:
    std::map<std::pair<VkRenderPass, uint32_t>, gpu::GraphicsPipeline> pipelines_;
};

}  // namespace splice::graph
