// The compute programs of the splat backends, with the descriptor sets that they share: 0 the frame's, 1 a model's
// surfels, 2 what they hand to each other (splat_buffers.h), 3 the frame's targets
// (shaders/glsl/include/splat_targets.glsl).
#pragma once

#include "engine/passes/frame_targets.h"
#include "engine/passes/splat_buffers.h"

#include <cstdint>
#include <functional>
#include <future>
#include <map>
#include <span>
#include <thread>
#include <tuple>
#include <vector>

namespace splice {

class SplatPrograms {
  public:
    enum class Stage : std::uint32_t {
        kSetup,
        kTileCells,
        kTileGather,
        kTileVisibility,
        kTileAttributes,
        kListScan,
        kListFill,
        kPointVisibility,
        kPointAttributes,
        kPointSums,
    };

    /// What pipelines are specialised for, beyond the frame's settings.
    struct Variant {
        bool composes = false;  // tiles become the picture
        bool mixed = false;     // several techniques serve the frame
        bool adds = false;      // point sums: to what is there
        TileCells cells = TileCells::kOthers;
        auto operator<=>(const Variant&) const = default;
    };

    struct Program {
        Stage stage;
        Variant variant;
    };

    SplatPrograms(gpu::Device& device, const FrameData& data, const SplatBuffers& buffers);

    /// Images and buffers that the passes of the frame work on; those that it does not have are not read.
    struct Targets {
        FrameTargets frame;
        graph::BufferHandle point_sums;
        bool composes = false, deferred = false, points = false;
    };
    void set_targets(const Targets& targets) { targets_ = targets; }

    /// Begins to make those pipelines that are not made yet, each on a thread of its own.
    void make_together(const FrameSettings& settings, std::span<const Program> programs);
    bool is_made(const FrameSettings& settings, const Program& program) const;
    /// Throws what making it threw.
    void wait_for(const FrameSettings& settings, const Program& program) { pipeline(settings, program); }

    /// The pipeline, which is made here if nobody began to, and sets 0, 2 and, where the stage uses it, 3.
    void bind(const graph::PassContext& context, Stage stage, const FrameSettings& settings, const Variant& variant);
    void push(VkCommandBuffer commands, const InstanceConstants& constants) const;
    /// The rest of a set-up job: set 1.
    void bind_surfels(VkCommandBuffer commands, VkDescriptorSet surfels) const;
    /// One workgroup a group, within the widest dispatch of any device.
    static void dispatch_groups(VkCommandBuffer commands, std::uint64_t groups);

  private:
    struct Sets {
        std::uint64_t plan_id = 0;
        VkDescriptorSet set = VK_NULL_HANDLE;
    };
    using Key = std::tuple<FrameVariant, Stage, Variant>;
    using Making = std::packaged_task<gpu::ComputePipeline()>;
    static Key key_of(const FrameSettings& settings, const Program& program) {
        return {frame_variant(settings), program.stage, program.variant};
    }
    std::vector<Making> begin_making(const FrameSettings& settings, std::span<const Program> programs);
    gpu::ComputePipeline make(const FrameSettings& settings, const Program& program) const;
    const gpu::ComputePipeline& pipeline(const FrameSettings& settings, const Program& program);
    VkDescriptorSet target_set(const graph::PassContext& context);

    gpu::Device& device_;
    const FrameData& data_;
    const SplatBuffers& buffers_;
    gpu::DescriptorSetLayout surfel_layout_, target_layout_;
    gpu::PipelineLayout layout_;
    gpu::ShaderModule setup_, cells_, gather_, list_scan_, list_fill_, point_visibility_, point_attributes_,
        point_sums_;
    gpu::UniqueSampler sampler_;
    gpu::DescriptorPool pool_;
    Targets targets_;
    Sets sets_;
    std::map<Key, std::shared_future<gpu::ComputePipeline>> pipelines_;
    std::vector<std::jthread> makers_;  // the last member: they use the others
};

}  // namespace splice
