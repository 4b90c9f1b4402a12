// The wires of boxes over the finished picture, hidden where surfaces are before them: View::kBoxes.
#pragma once

#include "engine/passes/frame_data.h"
#include "engine/passes/frame_targets.h"
#include "engine/render_graph/executor/executor.h"
#include "engine/scene/draw_list.h"
#include "engine/vulkan/buffer.h"

#include <map>
#include <utility>

namespace splice {

class BoxPass {
  public:
    BoxPass(gpu::Device& device, const FrameData& data);
    /// Draws InstanceDraws::boxes to targets.picture. No submitted work may still use the frame before.
    void add(graph::Graph& graph, FrameTargets& targets, const FrameSettings& settings, const DrawList& draws);

  private:
    void upload(const DrawList& draws);
    void draw(const graph::PassContext& context, const FrameSettings& settings, const DrawList& draws);
    gpu::GraphicsPipelineOptions pipeline_options(const FrameSettings& settings) const;

    gpu::Device& device_;
    const FrameData& data_;
    gpu::PipelineLayout layout_;
    gpu::ShaderModule vertex_, fragment_;
    gpu::Buffer boxes_;
    std::map<std::pair<FrameVariant, bool>, graph::PassPipelines> pipelines_;  // by whether samples are to be resolved
};

}  // namespace splice
