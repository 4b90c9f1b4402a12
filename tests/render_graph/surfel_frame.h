// The renderer's frame in miniature: flat colours instead of surfels, but the same passes, attachments and tests.
#pragma once

#include "engine/render_graph/executor/executor.h"
#include "engine/render_graph/graph.h"
#include "engine/vulkan/buffer.h"
#include "engine/vulkan/descriptor.h"
#include "engine/vulkan/device.h"
#include "engine/vulkan/pipeline.h"

#include <cstdint>
#include <functional>
#include <vector>

namespace splice::test {

class SurfelFrame {
  public:
    SurfelFrame(gpu::Device& device, uint32_t width, uint32_t height);

    /// Left half: weighted red and blue at depth 0.6. Right half: the triangle colour at depth 0.4.
    void declare(graph::Graph& graph);
    void record(graph::Executor& executor, VkCommandBuffer commands, uint32_t frame_slot);
    /// RGBA8, of the last frame that is done.
    std::vector<uint8_t> pixels() const;
    /// Runs the frame and returns its pixels.
    std::vector<uint8_t> run(graph::Executor& executor, uint32_t frame_slot = 0);

    /// Without the passes of the surfels: a view mode that shows the triangles only.
    bool surfels = true;
    float triangle_red = 0.2F;

  private:
    struct Constants {
        float colour[4];
        float depth;
    };
    void draw(const graph::PassContext& context, graph::PassPipelines& pipelines, const Constants& constants,
              const std::function<void(gpu::GraphicsPipelineOptions&)>& state, VkPipelineLayout layout,
              const gpu::ShaderModule& fragment);

    gpu::Device* device_;
    uint32_t width_, height_;
    gpu::ShaderModule vertex_, flat_, divide_;
    gpu::DescriptorSetLayout set_layout_;
    gpu::PipelineLayout plain_layout_, divide_layout_;
    gpu::DescriptorPool pool_;
    VkDescriptorSet set_ = VK_NULL_HANDLE;
    uint64_t set_plan_ = 0;
    graph::PassPipelines triangle_, visibility_, attribute_, normalise_;
    gpu::Buffer pixels_;
    graph::BufferHandle pixels_handle_;
};

}  // namespace splice::test
