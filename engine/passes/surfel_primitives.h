// How surfels get to the rasteriser, the same for the visibility and the attribute pass: point sprites where the device
// draws them right, quads where it does not (larger than its points, or the centre beyond the frustum).
#pragma once

#include "engine/passes/frame_data.h"
#include "engine/render_graph/executor/executor.h"
#include "engine/scene/draw_list.h"

#include <functional>
#include <map>
#include <utility>

namespace splice {

/// Vertex input, topology and constant 0 of surfel_vertex.glsl.
void add_surfel_input(gpu::GraphicsPipelineOptions& options, bool quads);

/// Of a buffer with `stride` bytes a record: those from `first` on, as that vertex input takes them.
void bind_surfels(VkCommandBuffer commands, VkBuffer records, std::uint64_t first, std::uint64_t stride);

class SurfelPrimitives {
  public:
    SurfelPrimitives(gpu::Device& device, const FrameData& data);

    VkPipelineLayout layout() const { return layout_.handle(); }

    /// Draws the surfels of the list. `options` gives the pass's own state; vertex input, topology, layout and
    /// constants are filled in here.
    void draw(const graph::PassContext& context, const FrameSettings& settings, const DrawList& draws,
              const std::function<gpu::GraphicsPipelineOptions()>& options);

  private:
    void draw_ranges(const graph::PassContext& context, const FrameSettings& settings, const InstanceDraws& instance,
                     const std::function<gpu::GraphicsPipelineOptions()>& options, bool quads);

    const gpu::Device& device_;
    const FrameData& data_;
    gpu::PipelineLayout layout_;
    std::map<std::pair<FrameVariant, bool>, graph::PassPipelines> pipelines_;  // quads
};

}  // namespace splice
