// Subpass 3: lit colours of all surfels within epsilon of the visible surface, weighted by the EWA resampling filter
// and summed (thesis 3.4.2, EWA filtering). Deferred: their normals and albedos, which the normalisation lights.
#pragma once

#include "engine/passes/frame_targets.h"
#include "engine/passes/surfel_primitives.h"

namespace splice {

/// Tests and state of every pass that blends attributes.
gpu::GraphicsPipelineOptions attribute_state(bool deferred);

class SurfelAttributePass {
  public:
    SurfelAttributePass(gpu::Device& device, const FrameData& data);
    void add(graph::Graph& graph, FrameTargets& targets, const FrameSettings& settings, const DrawList& draws);

  private:
    gpu::GraphicsPipelineOptions pipeline_options(bool deferred) const;

    SurfelPrimitives primitives_;
    gpu::ShaderModule vertex_, fragment_, deferred_vertex_, deferred_fragment_;
};

}  // namespace splice
