// Subpass 3: lit colours of all surfels within epsilon of the visible surface, weighted by the EWA resampling filter
// and summed (thesis 3.4.2, EWA filtering).
#pragma once

#include "engine/passes/frame_targets.h"
#include "engine/passes/surfel_primitives.h"

namespace splice {

class SurfelAttributePass {
  public:
    SurfelAttributePass(gpu::Device& device, const FrameData& data);
    void add(graph::Graph& graph, FrameTargets& targets, const FrameSettings& settings, const DrawList& draws);

  private:
    gpu::GraphicsPipelineOptions pipeline_options() const;

    SurfelPrimitives primitives_;
    gpu::ShaderModule vertex_, fragment_;
};

}  // namespace splice
