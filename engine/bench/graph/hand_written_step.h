// The pieces of a frame written by hand against Vulkan: barriers, then one render pass with its subpasses and draws.
// Everything is filled in when the frame is set up, so that recording only hands it over.
#pragma once

#include "engine/bench/graph/pass_shaders.h"
#include "engine/vulkan/device.h"
#include "engine/vulkan/handle.h"
#include "engine/vulkan/pipeline.h"

#include <vulkan/vulkan_core.h>

#include <cstdint>
#include <initializer_list>
#include <vector>

namespace splice::bench {

/// One pass: a pipeline, a descriptor set and draws.
struct HandSubpass {
    gpu::GraphicsPipeline pipeline;
    VkPipelineLayout layout = VK_NULL_HANDLE;
    VkDescriptorSet set = VK_NULL_HANDLE;
    std::vector<Rectangle> draws;
};

struct HandStep {
    std::vector<VkImageMemoryBarrier2> barriers;
    gpu::UniqueRenderPass render_pass;
    gpu::UniqueFramebuffer framebuffer;
    VkExtent2D extent{};
    std::vector<VkClearValue> clear_values;  ///< one an attachment
    std::vector<HandSubpass> subpasses;

    void record(VkCommandBuffer commands) const;
    /// Calls of vkCmd functions in record().
    uint32_t commands() const;
};

void record_barriers(VkCommandBuffer commands, const std::vector<VkImageMemoryBarrier2>& barriers);

/// Stages and accesses on one side of a barrier.
struct HandScope {
    VkPipelineStageFlags2 stages;
    VkAccessFlags2 access;
};
VkImageMemoryBarrier2 hand_barrier(const gpu::Image& image, HandScope source, HandScope destination,
                                   VkImageLayout old_layout, VkImageLayout new_layout);

struct HandAttachment {
    const gpu::Image* image;
    VkAttachmentLoadOp load;
    VkAttachmentStoreOp store;
    VkImageLayout initial_layout, final_layout;
};
/// Indices of attachments; -1: none.
struct HandSubpassAttachments {
    std::vector<uint32_t> colours, inputs;
    int depth = -1;
};

gpu::UniqueRenderPass hand_render_pass(const gpu::Device& device, const std::vector<HandAttachment>& attachments,
                                       const std::vector<HandSubpassAttachments>& subpasses,
                                       const std::vector<VkSubpassDependency2>& dependencies);
/// By region.
VkSubpassDependency2 hand_dependency(uint32_t source, uint32_t destination, HandScope before, HandScope after);

gpu::UniqueFramebuffer hand_framebuffer(const gpu::Device& device, VkRenderPass render_pass,
                                        const std::vector<HandAttachment>& attachments);

}  // namespace splice::bench
