// Subpass 2: the true depth of every surfel, moved away from the eye by epsilon, and the stencil value that says which
// pixels are the surfels' (thesis 3.4.2, visibility splatting).
#pragma once

#include "engine/passes/frame_targets.h"
#include "engine/passes/surfel_primitives.h"

namespace splice {

/// Tests and state of every pass that decides what is visible: whoever is nearest owns the pixel; of equal depths, the
/// triangle that was there first.
gpu::GraphicsPipelineOptions visibility_state();

class SurfelVisibilityPass {
  public:
    SurfelVisibilityPass(gpu::Device& device, const FrameData& data);
    void add(graph::Graph& graph, FrameTargets& targets, const FrameSettings& settings, const DrawList& draws);

  private:
    gpu::GraphicsPipelineOptions pipeline_options() const;

    SurfelPrimitives primitives_;
    gpu::ShaderModule vertex_, fragment_;
};

}  // namespace splice
