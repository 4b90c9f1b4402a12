// Several samples a pixel become one, where a frame is drawn with more than one (FrameSettings::antialias).
#pragma once

#include "engine/passes/frame_data.h"
#include "engine/render_graph/executor/executor.h"
#include "engine/render_graph/graph.h"
#include "engine/vulkan/handle.h"

#include <cstdint>

namespace splice {

/// Linear colours of samples, before they are resolved.
inline constexpr VkFormat kSampleFormat = VK_FORMAT_R16G16B16A16_SFLOAT;

class ResolvePass {
  public:
    ResolvePass(gpu::Device& device, const FrameData& data);
    /// `picture` is cleared to `empty`; `samples` is FrameSettings::antialias times as wide and high. Returns the
    /// picture as written.
    graph::ImageHandle add(graph::Graph& graph, graph::ImageHandle samples, graph::ImageHandle picture,
                           const VkClearValue& empty);

  private:
    struct Inputs {
        std::uint64_t plan_id = 0;
        VkDescriptorSet set = VK_NULL_HANDLE;
    };
    void draw(const graph::PassContext& context, graph::ImageHandle samples);
    VkDescriptorSet input_set(const graph::PassContext& context, graph::ImageHandle samples);

    const gpu::Device& device_;
    const FrameData& data_;
    gpu::DescriptorSetLayout input_layout_;
    gpu::PipelineLayout layout_;
    gpu::ShaderModule vertex_, fragment_;
    gpu::UniqueSampler sampler_;
    gpu::DescriptorPool pool_;
    Inputs inputs_;
    graph::PassPipelines pipelines_;
};

}  // namespace splice
