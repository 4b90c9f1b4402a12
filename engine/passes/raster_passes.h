// The raster backend: one primitive a splat, a triangle fitted to its footprint, from the list that setup made. The
// visibility and the attribute pass as sprites draw them, with the same fragments.
#pragma once

#include "engine/passes/frame_data.h"
#include "engine/passes/frame_targets.h"
#include "engine/passes/splat_buffers.h"
#include "engine/render_graph/executor/executor.h"

#include <map>

namespace splice {

class RasterPasses {
  public:
    RasterPasses(gpu::Device& device, const FrameData& data, const SplatBuffers& buffers);

    /// Of the splats that the handles' list holds; `settings` must live until the graph has been executed.
    void add_visibility(graph::Graph& graph, FrameTargets& targets, const FrameSettings& settings,
                        const SplatHandles& handles);
    /// `fresh`: nothing is in the sums yet.
    void add_attributes(graph::Graph& graph, FrameTargets& targets, const FrameSettings& settings,
                        const SplatHandles& handles, bool fresh);

  private:
    static void read_splats(graph::Pass& pass, const SplatHandles& handles);
    void draw(const graph::PassContext& context, const FrameSettings& settings, bool attributes);
    gpu::GraphicsPipelineOptions pipeline_options(const FrameSettings& settings, bool attributes) const;

    const gpu::Device& device_;
    const FrameData& data_;
    const SplatBuffers& buffers_;
    gpu::DescriptorSetLayout surfel_layout_;
    gpu::PipelineLayout layout_;
    gpu::ShaderModule visibility_vertex_, visibility_fragment_, attribute_vertex_, attribute_fragment_,
        deferred_vertex_, deferred_fragment_;
    std::map<std::pair<FrameVariant, bool>, graph::PassPipelines> pipelines_;  // attributes
};

}  // namespace splice
