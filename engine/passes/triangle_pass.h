// Subpass 1: triangle patches, lit per pixel, into the depth buffer that surfels are spliced into.
#pragma once

#include "engine/passes/frame_data.h"
#include "engine/passes/frame_targets.h"
#include "engine/render_graph/executor/executor.h"
#include "engine/scene/draw_list.h"

#include <map>
#include <tuple>

namespace splice {

class TrianglePass {
  public:
    TrianglePass(gpu::Device& device, const FrameData& data);
    void add(graph::Graph& graph, FrameTargets& targets, const FrameSettings& settings, const DrawList& draws);

  private:
    void draw(const graph::PassContext& context, const FrameSettings& settings, const DrawList& draws, bool wires);
    gpu::GraphicsPipelineOptions pipeline_options(const FrameSettings& settings, bool wires, bool two_sided) const;

    const gpu::Device& device_;
    const FrameData& data_;
    gpu::DescriptorSetLayout material_layout_;
    gpu::PipelineLayout layout_;
    gpu::ShaderModule vertex_, fragment_;
    std::map<std::tuple<FrameVariant, bool, bool>, graph::PassPipelines> pipelines_;  // wires, two-sided
};

}  // namespace splice
