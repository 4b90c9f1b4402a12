// One view of the deferred family without the render graph: the same render passes, barriers and draws, each thought
// out by hand. What recording costs without a graph, and what the picture has to be.
#pragma once

#include "engine/bench/graph/deferred.h"
#include "engine/bench/graph/hand_written_step.h"
#include "engine/bench/graph/pass_shaders.h"
#include "engine/vulkan/image.h"

#include <cstddef>
#include <cstdint>
#include <deque>
#include <string>
#include <vector>

namespace splice::bench {

struct RecordedCounts {
    uint32_t passes = 0, render_passes = 0, barrier_commands = 0, barriers = 0;
    friend bool operator==(const RecordedCounts&, const RecordedCounts&) = default;
};

class HandWrittenDeferred {
  public:
    /// `view.lights` at least 1, `view.bloom_levels` at least 1. `objects`: draws in a pass that writes depth.
    HandWrittenDeferred(gpu::Device& device, const PassShaders& shaders, const DeferredView& view, uint32_t width,
                        uint32_t height, uint32_t objects);

    void record(VkCommandBuffer commands) const;
    RecordedCounts counts() const;
    /// Calls of vkCmd functions in record().
    uint32_t commands() const;
    /// The picture after all submitted work.
    std::vector<std::byte> results();

  private:
    const gpu::Image& add_image(const std::string& name, VkFormat format, uint32_t width, uint32_t height,
                                VkImageUsageFlags usage);
    void draw_shadow(uint32_t light);
    void draw_geometry_and_lights();
    void find_occlusion();
    void blur_occlusion();
    void add_ambient();
    void shrink(uint32_t level);
    void grow(uint32_t level);
    void grow_and_map_tones();
    HandStep& begin_step(const std::vector<HandAttachment>& attachments,
                         const std::vector<HandSubpassAttachments>& subpasses,
                         const std::vector<VkSubpassDependency2>& dependencies);
    /// `seed`: the index of the pass in the family's declaration.
    void add_subpass(HandStep& step, uint32_t seed, const PassShape& shape, const std::vector<ReadImage>& sampled,
                     const std::vector<ReadImage>& inputs);

    gpu::Device* device_;
    const PassShaders* shaders_;
    DeferredView view_;
    uint32_t width_, height_, objects_;
    gpu::DescriptorPool pool_;
    std::deque<gpu::Image> images_;  // the pointers below point into it
    const gpu::Image *albedo_, *normal_, *depth_, *light_, *occlusion_, *blurred_ = nullptr, *picture_;
    std::vector<const gpu::Image*> shadows_, bloom_;  // bloom_[0] is the light
    std::deque<HandStep> steps_;
    std::vector<VkImageMemoryBarrier2> final_barriers_;
};

}  // namespace splice::bench
