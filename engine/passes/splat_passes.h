// The splat backends that share one compute pass a frame: setup culls surfels and records each splat (a record, its
// block's bounds; a bit in the mask of each cell of the screen for tiles, a place in the list for rasterising); then
// each technique draws its own. A frame of tiles alone is gathered in one go. Otherwise all visibility comes before all
// attributes, whoever draws them: the nearest of what compute passes found visible goes to the frame's depth, and every
// technique adds to the frame's sums. See shaders/glsl/include/tile.glsl.
#pragma once

#include "engine/passes/frame_targets.h"
#include "engine/passes/left_out_cells.h"
#include "engine/passes/raster_passes.h"
#include "engine/passes/splat_buffers.h"
#include "engine/passes/splat_depth_pass.h"
#include "engine/passes/splat_plan.h"
#include "engine/passes/splat_programs.h"
#include "engine/passes/surfel_normalise_pass.h"
#include "engine/scene/draw_list.h"

#include <cstdint>
#include <optional>
#include <vector>

namespace splice {

class SplatPasses {
  public:
    /// `most_groups`: groups of surfels that are worked on at once; 0: as many as the device's limits allow. Frames of
    /// more are drawn batch by batch.
    SplatPasses(gpu::Device& device, const FrameData& data, std::uint64_t most_groups);

    /// The techniques that come nearest to what is wanted, by the device's abilities and the view; none: only sprites
    /// can draw the frame. Without points for the small splats, both are the same.
    std::optional<Techniques> choose(Backend wanted, const FrameSettings& settings) const;
    /// Pixels: splats up to this size become points unless somebody says otherwise.
    double default_points_below(Backend wanted) const;

    /// What draws which surfels of the frame. `draws` must live until the frame's graph has been executed.
    void plan(const DrawList& draws, const Techniques& techniques, const FrameSettings& settings);
    const SetupCounts& counts() const { return counts_; }
    /// Whether there is anything to draw.
    bool empty() const { return groups_.empty(); }
    /// Whether the passes finish the picture themselves, over what targets.picture has of triangles; else the normalise
    /// pass does.
    bool composes(const FrameSettings& settings) const;
    /// Of the frame that was planned; how to normalise it, if at all. `settings` must live until the graph has been
    /// executed. No submitted work may still use the frame before.
    SurfelOwnership add(graph::Graph& graph, graph::Bindings& bindings, FrameTargets& targets,
                        const FrameSettings& settings);
    /// After the frame was executed: whether some of it was left out, what that lacked being made now. Then it is to be
    /// added and executed again.
    bool make_lacking() { return left_out_.make_lacking(); }
    /// Begins to make, on other threads, the pipelines that a frame of these settings needs, if it is drawn by these
    /// techniques in one batch.
    void make_for(const FrameSettings& settings, const Techniques& techniques);

  private:
    using Stage = SplatPrograms::Stage;
    using Variant = SplatPrograms::Variant;
    // Where a batch stands among all.
    struct Place {
        bool first, last;
    };
    enum class Phase { kVisibility, kAttributes };

    bool uses(Technique technique) const;
    bool is_mixed() const { return uses(Technique::kPoint) || uses(Technique::kRaster); }
    SurfelOwnership add_tiles(graph::Graph& graph, graph::Bindings& bindings, FrameTargets& targets,
                              const FrameSettings& settings);
    SurfelOwnership add_mixed(graph::Graph& graph, FrameTargets& targets, const FrameSettings& settings);

    /// Those that every frame of one batch of tiles needs and that take long.
    void make_gathering(const FrameSettings& settings, bool composed);
    void add_setup(graph::Graph& graph, const FrameSettings& settings, const SplatBatch& batch);
    void add_list(graph::Graph& graph, const FrameSettings& settings, const GroupRange& range);
    /// For tiles without splats, which are not gathered.
    void add_sum_clear(graph::Graph& graph, FrameTargets& targets, const FrameSettings& settings);
    void add_gather(graph::Graph& graph, FrameTargets& targets, const FrameSettings& settings);
    void add_segments(graph::Graph& graph, FrameTargets& targets, const FrameSettings& settings,
                      std::vector<Stage> stages, Place place, const Variant& variant);
    void add_point_clear(graph::Graph& graph, FrameTargets& targets);
    void add_points(graph::Graph& graph, FrameTargets& targets, const FrameSettings& settings, const GroupRange& range,
                    Phase phase);
    void add_point_sums(graph::Graph& graph, FrameTargets& targets, const FrameSettings& settings);
    /// What every pass that gathers reads and writes; `fresh`: nothing is there yet.
    void read_inputs(graph::Pass& pass, const FrameTargets& targets) const;
    void write_sums(graph::Pass& pass, FrameTargets& targets, const FrameSettings& settings, bool fresh);

    void set_up(const graph::PassContext& context, const FrameSettings& settings, const SplatBatch& batch);
    /// `waits`: for another stage of the same pass.
    void segment(const graph::PassContext& context, const FrameSettings& settings, Stage stage, Place place,
                 const Variant& variant, bool waits);

    const gpu::Device& device_;
    std::uint64_t most_groups_;
    bool supported_, tiles_supported_;
    SplatBuffers buffers_;
    SplatPrograms programs_;
    LeftOutCells left_out_;
    RasterPasses raster_;
    SplatDepthPass depth_;
    SplatHandles handles_;
    graph::BufferHandle point_sums_;
    bool summed_ = false;  // something is in the sums
    std::vector<SplatBatch> batches_;
    std::vector<SplatGroup> groups_;  // of all batches
    SetupCounts counts_;
};

}  // namespace splice
