// Subpass 4: full screen; sums divided by weights where surfels own the pixel, triangles elsewhere (thesis 3.4.2,
// normalization); with deferred shading, the mean normal and albedo are lit (Botsch et al. 2005). Reads the other
// subpasses' results at its own pixel only.
#pragma once

#include "engine/passes/frame_data.h"
#include "engine/passes/frame_targets.h"
#include "engine/render_graph/executor/executor.h"

#include <cstdint>
#include <map>
#include <tuple>

namespace splice {

/// What says that surfels own a pixel: the stencil value of the visibility pass, or, where no such pass was, that there
/// is a weight.
enum class SurfelOwnership : std::uint32_t { kStencil, kWeight };

/// What a picture holds where nothing is drawn.
VkClearValue empty_picture(View view, const Background& background);

class SurfelNormalisePass {
  public:
    SurfelNormalisePass(gpu::Device& device, const FrameData& data);
    /// `triangles`: whether any are drawn; what they own is not looked for where there are none.
    void add(graph::Graph& graph, FrameTargets& targets, const FrameSettings& settings, const Background& background,
             SurfelOwnership ownership, bool triangles);

  private:
    struct Inputs {
        std::uint64_t plan_id = 0;
        VkDescriptorSet set = VK_NULL_HANDLE;
    };
    void draw(const graph::PassContext& context, const FrameTargets& targets, const FrameSettings& settings,
              SurfelOwnership ownership, bool triangles);
    VkDescriptorSet input_set(const graph::PassContext& context, const FrameTargets& targets, bool deferred);
    gpu::GraphicsPipelineOptions pipeline_options(const FrameSettings& settings, SurfelOwnership ownership,
                                                  std::uint32_t owner) const;

    const gpu::Device& device_;
    const FrameData& data_;
    gpu::DescriptorSetLayout input_layout_;
    gpu::PipelineLayout layout_;
    gpu::ShaderModule vertex_, fragment_, deferred_fragment_;
    gpu::DescriptorPool pool_;
    Inputs inputs_;
    // By owner, and by whether samples are to be resolved.
    std::map<std::tuple<FrameVariant, SurfelOwnership, std::uint32_t, bool>, graph::PassPipelines> pipelines_;
};

}  // namespace splice
