// The tile backend: compute passes that fill the accumulation as the visibility and the attribute pass do, for devices
// that rasterise in software. Setup (a record a splat), binning (count, scan, list) and gathering are passes of the
// graph; see shaders/glsl/include/tile.glsl for what they hand to each other.
#pragma once

#include "engine/passes/frame_targets.h"
#include "engine/passes/tile_buffers.h"
#include "engine/scene/draw_list.h"

#include <cstdint>
#include <map>
#include <string>

namespace splice {

class TilePasses {
  public:
    TilePasses(gpu::Device& device, const FrameData& data);

    /// Whether the backend can draw this frame: the view, the device's abilities and its limits.
    bool can_draw(const FrameSettings& settings, const DrawList& draws) const;
    /// Before add(). No submitted work may still use the frame before.
    void prepare(const FrameSettings& settings, const DrawList& draws);
    void add(graph::Graph& graph, graph::Bindings& bindings, FrameTargets& targets, const FrameSettings& settings,
             const DrawList& draws);
    /// After a frame: whether its lists had room. If not, prepare() makes it, provided that can_draw() still holds, and
    /// the frame is to be drawn again.
    bool complete() const { return buffers_.entries_needed() <= buffers_.capacity(); }
    /// After a frame that another backend drew: the next one is judged afresh.
    void forget() { buffers_.forget(); }

  private:
    struct Sets {
        std::uint64_t plan_id = 0;
        VkDescriptorSet set = VK_NULL_HANDLE;
    };
    std::uint64_t entries_for(const DrawList& draws) const;
    void add_setup(graph::Graph& graph, TileHandles& handles, const FrameSettings& settings, const DrawList& draws);
    void add_lists(graph::Graph& graph, TileHandles& handles, const FrameSettings& settings);
    void setup(const graph::PassContext& context, const FrameSettings& settings, const DrawList& draws);
    void bind(const graph::PassContext& context, const gpu::ShaderModule& shader, const char* name,
              const FrameSettings& settings);
    VkDescriptorSet tile_set(const graph::PassContext& context);

    gpu::Device& device_;
    const FrameData& data_;
    bool supported_;
    TileBuffers buffers_;
    TileHandles handles_;
    FrameTargets targets_;
    gpu::DescriptorSetLayout surfel_layout_, tile_layout_;
    gpu::PipelineLayout layout_;
    gpu::ShaderModule setup_, count_, scan_, starts_, list_, gather_;
    gpu::UniqueSampler sampler_;
    gpu::DescriptorPool pool_;
    Sets sets_;
    std::map<std::pair<FrameVariant, std::string>, gpu::ComputePipeline> pipelines_;
};

}  // namespace splice
