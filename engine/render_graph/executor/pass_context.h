// What the record function of a pass works with.
#pragma once

#include "engine/render_graph/graph.h"
#include "engine/vulkan/handle.h"

#include <vulkan/vulkan_core.h>

#include <cstdint>
#include <memory>
#include <span>

namespace splice::graph {

/// A real resource of the running frame.
struct BoundImage {
    VkImage image = VK_NULL_HANDLE;
    VkImageView view = VK_NULL_HANDLE;          ///< all aspects
    VkImageView depth_view = VK_NULL_HANDLE;    ///< depth aspect of a depth-stencil image; else the same as view
    VkImageView stencil_view = VK_NULL_HANDLE;  ///< stencil aspect, where there is one
    VkImageUsageFlags usage = 0;
};

struct BoundResource {
    BoundImage image;
    VkBuffer buffer = VK_NULL_HANDLE;
};

struct PassContext {
    VkCommandBuffer commands = VK_NULL_HANDLE;

    // Graphics passes: inside the render pass; viewport (y down, depth 0..1) and scissor cover `extent`, set anew for
    // every pass. Pipelines must be created for (render_pass, subpass).
    VkRenderPass render_pass = VK_NULL_HANDLE;
    /// The same for whoever outlives it: Vulkan may give the handle of one that was destroyed to another. Lives as long
    /// as the plan; not null inside a render pass. (A pointer to it, since copies of shared pointers cost as much as
    /// some commands.)
    const std::shared_ptr<const gpu::UniqueRenderPass>* render_pass_owner = nullptr;
    uint32_t subpass = 0;
    VkExtent2D extent{};
    VkSampleCountFlagBits samples = VK_SAMPLE_COUNT_1_BIT;

    /// Identifies the compiled plan and never repeats within an executor. While it is the same, render passes and
    /// transient resources are the same: keep descriptor sets under (plan_id, pass), and under history_side too if the
    /// pass uses a history, as its two halves swap.
    uint64_t plan_id = 0;
    uint32_t history_side = 0;  ///< 0 or 1 in turns
    /// Frame in flight, 0 .. frames - 1: per-frame data of this slot is free to be overwritten.
    uint32_t frame_slot = 0;

    std::span<const BoundResource> resources;

    VkImage image(ImageHandle handle) const { return resources[handle.resource].image.image; }
    VkBuffer buffer(BufferHandle handle) const { return resources[handle.resource].buffer; }
    /// For storage, sampled and input reads of images of one aspect.
    VkImageView view(ImageHandle handle) const { return resources[handle.resource].image.view; }
    /// Shaders read depth and stencil through views of one aspect.
    VkImageView depth_view(ImageHandle handle) const { return resources[handle.resource].image.depth_view; }
    VkImageView stencil_view(ImageHandle handle) const { return resources[handle.resource].image.stencil_view; }
};

}  // namespace splice::graph
