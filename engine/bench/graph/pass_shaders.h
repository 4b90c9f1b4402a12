// The drawing of the benchmark's passes: rectangles whose shader adds up whatever the pass reads. Shared by the graph's
// passes and by the twin written by hand, so that both record the same draws.
#pragma once

#include "engine/vulkan/descriptor.h"
#include "engine/vulkan/device.h"
#include "engine/vulkan/image.h"
#include "engine/vulkan/pipeline.h"

#include <vulkan/vulkan_core.h>

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace splice::bench {

inline constexpr uint32_t kMaxSampled = 8;  ///< further images that a pass samples are not looked at
inline constexpr uint32_t kMaxInputs = 3, kMaxOutputs = 2;

/// What of a pass its pipeline depends on.
struct PassShape {
    uint32_t sampled = 0, inputs = 0, outputs = 0;
    bool depth_written = false;
    std::vector<bool> blended = {};  ///< one an output: added to what is there
};

struct ReadImage {
    VkImageView view = VK_NULL_HANDLE;
    VkImageLayout layout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;
};

class PassShaders {
  public:
    explicit PassShaders(gpu::Device& device);

    /// Render pass and subpass remain to be filled in.
    gpu::GraphicsPipelineOptions pipeline_options(const PassShape& shape) const;
    VkPipelineLayout layout(uint32_t inputs) const { return layouts_[inputs].handle(); }
    const gpu::DescriptorSetLayout& set_layout(uint32_t inputs) const { return set_layouts_[inputs]; }
    void write_set(VkDescriptorSet set, std::span<const ReadImage> sampled, std::span<const ReadImage> inputs) const;

  private:
    gpu::Device* device_;
    gpu::ShaderModule vertex_;
    std::array<std::array<gpu::ShaderModule, kMaxOutputs>, kMaxInputs + 1> fragments_;
    std::array<gpu::DescriptorSetLayout, kMaxInputs + 1> set_layouts_;
    std::array<gpu::PipelineLayout, kMaxInputs + 1> layouts_;
    gpu::UniqueSampler sampler_;
    gpu::Image unused_;  // for the sampled images that a pass does not have
};

/// Push constants of one draw.
struct Rectangle {
    float tint[4];
    float left, top, right, bottom;  ///< 0..1 of the target
    float depth;
};

/// One covers the target, several are strewn over it. `seed` tells passes apart.
std::vector<Rectangle> rectangles(uint32_t seed, uint32_t count);
/// Records one draw each, with its constants.
void draw_rectangles(VkCommandBuffer commands, VkPipelineLayout layout, std::span<const Rectangle> rectangles);

}  // namespace splice::bench
