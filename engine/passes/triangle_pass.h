// Subpass 1: triangle patches, lit per pixel, into the depth buffer that surfels are spliced into. Their colours go to
// targets.triangle_colour, for the normalise pass, or where surfels need none, straight to the picture.
#pragma once

#include "engine/passes/frame_data.h"
#include "engine/passes/frame_targets.h"
#include "engine/render_graph/executor/executor.h"
#include "engine/scene/draw_list.h"

#include <map>
#include <optional>
#include <utility>

namespace splice {

class TrianglePass {
  public:
    TrianglePass(gpu::Device& device, const FrameData& data);
    /// `picture`: what targets.picture holds where nothing is, if triangles are to be drawn to it.
    void add(graph::Graph& graph, FrameTargets& targets, const FrameSettings& settings, const DrawList& draws,
             const std::optional<VkClearValue>& picture);

  private:
    struct Variant {
        bool wires, two_sided, to_picture;
        auto operator<=>(const Variant&) const = default;
    };
    void draw(const graph::PassContext& context, const FrameSettings& settings, const DrawList& draws, bool to_picture,
              bool wires);
    gpu::GraphicsPipelineOptions pipeline_options(const FrameSettings& settings, const Variant& variant) const;

    const gpu::Device& device_;
    const FrameData& data_;
    gpu::DescriptorSetLayout material_layout_;
    gpu::PipelineLayout layout_;
    gpu::ShaderModule vertex_, fragment_;
    std::map<std::pair<FrameVariant, Variant>, graph::PassPipelines> pipelines_;
};

}  // namespace splice
