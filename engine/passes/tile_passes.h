// The tile backend: compute passes that fill the accumulation as the visibility and the attribute pass do, for devices
// that rasterise in software. Setup (a record a splat, a bit in the mask of each cell of the screen) and gathering are
// passes of the graph; see shaders/glsl/include/tile.glsl for what they hand to each other.
#pragma once

#include "engine/passes/frame_targets.h"
#include "engine/passes/tile_buffers.h"
#include "engine/scene/draw_list.h"

#include <cstdint>
#include <map>
#include <tuple>
#include <vector>

namespace splice {

class TilePasses {
  public:
    /// `most_groups`: groups of surfels that are worked on at once; 0: as many as the device's limits allow. Frames of
    /// more are drawn batch by batch.
    TilePasses(gpu::Device& device, const FrameData& data, std::uint64_t most_groups);

    /// Whether the backend can draw this frame: the device's abilities, and the view.
    bool can_draw(const FrameSettings& settings) const;
    /// Whether add() makes the picture; if not, the normalise pass does. Pictures of numbers and samples, and those
    /// that are lit afterwards, it leaves alone.
    static bool composes(const FrameSettings& settings) {
        return !is_numeric(settings.view) && settings.antialias == 1 && !is_deferred(settings);
    }
    /// `draws` and `settings` must live until the graph has been executed. No submitted work may still use the frame
    /// before.
    void add(graph::Graph& graph, graph::Bindings& bindings, FrameTargets& targets, const FrameSettings& settings,
             const Background& background, const DrawList& draws);

  private:
    enum class Stage : std::uint32_t { kSetup, kCells, kGather, kSegmentVisibility, kSegmentAttributes };

    // Consecutive surfels of one model, and their first group in the batch.
    struct Job {
        const InstanceDraws* instance;
        VkDescriptorSet surfels;
        std::uint32_t first_surfel, count, first_group;
    };
    struct Batch {
        std::vector<Job> jobs;
        std::uint64_t groups = 0;
    };
    // Where a batch stands among all.
    struct Range {
        bool first, last;
    };
    struct Sets {
        std::uint64_t plan_id = 0;
        VkDescriptorSet set = VK_NULL_HANDLE;
    };

    void plan(const DrawList& draws);
    void add_batch(graph::Graph& graph, const FrameSettings& settings, const Batch& batch);
    /// What every pass that gathers reads.
    void read_inputs(graph::Pass& pass, const FrameTargets& targets) const;
    void add_gather(graph::Graph& graph, FrameTargets& targets, const FrameSettings& settings);
    void add_segments(graph::Graph& graph, FrameTargets& targets, const FrameSettings& settings,
                      std::vector<Stage> stages, Range range);
    void setup(const graph::PassContext& context, const FrameSettings& settings, const Batch& batch);
    /// What every pass that gathers writes; `fresh`: nothing is there yet.
    void write_outputs(graph::Pass& pass, FrameTargets& targets, const FrameSettings& settings, bool fresh);
    void segment(const graph::PassContext& context, const FrameSettings& settings, Stage stage, Range range);
    void bind(const graph::PassContext& context, Stage stage, const FrameSettings& settings);
    VkDescriptorSet tile_set(const graph::PassContext& context);

    gpu::Device& device_;
    const FrameData& data_;
    std::uint64_t most_groups_;
    bool supported_;
    TileBuffers buffers_;
    TileHandles handles_;
    FrameTargets targets_;
    bool composes_ = false, deferred_ = false;
    graph::ImageHandle segment_depth_;
    std::vector<Batch> batches_;
    gpu::DescriptorSetLayout surfel_layout_, tile_layout_;
    gpu::PipelineLayout layout_;
    gpu::ShaderModule setup_, cells_, gather_;
    gpu::UniqueSampler sampler_;
    gpu::DescriptorPool pool_;
    Sets sets_;
    std::map<std::tuple<FrameVariant, Stage, bool>, gpu::ComputePipeline> pipelines_;  // bool: composes()
};

}  // namespace splice
