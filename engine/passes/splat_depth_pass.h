// What compute passes found visible (FrameTargets::splat_depth) becomes the frame's depth, and, by the stencil value,
// the surfels' own: where it is nearer than what is there.
#pragma once

#include "engine/passes/frame_data.h"
#include "engine/passes/frame_targets.h"
#include "engine/render_graph/executor/executor.h"

#include <cstdint>

namespace splice {

class SplatDepthPass {
  public:
    SplatDepthPass(gpu::Device& device, const FrameData& data);
    void add(graph::Graph& graph, FrameTargets& targets);

  private:
    void draw(const graph::PassContext& context, graph::ImageHandle splat_depth);

    const gpu::Device& device_;
    gpu::DescriptorSetLayout input_layout_;
    gpu::PipelineLayout layout_;
    gpu::ShaderModule vertex_, fragment_;
    gpu::UniqueSampler sampler_;
    gpu::DescriptorPool pool_;
    std::uint64_t plan_id_ = 0;  // of set_
    VkDescriptorSet set_ = VK_NULL_HANDLE;
    graph::PassPipelines pipelines_;
};

}  // namespace splice
