#include "engine/render_graph/executor/histories.h"

namespace splice::graph {
namespace {

constexpr VkAccessFlags2 kEveryAccess = VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT;

/// Clearing waits for everything before it, everything after waits for clearing: a reset is rare.
void transition(VkCommandBuffer commands, VkImage image, VkFormat format, VkImageLayout from, VkImageLayout to) {
    VkImageMemoryBarrier2 barrier{};
    barrier.sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2;
    barrier.srcStageMask = barrier.dstStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
    barrier.srcAccessMask = VK_ACCESS_2_MEMORY_WRITE_BIT;
    barrier.dstAccessMask = kEveryAccess;
    barrier.oldLayout = from;
    barrier.newLayout = to;
    barrier.srcQueueFamilyIndex = barrier.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
    barrier.image = image;
    barrier.subresourceRange = {gpu::format_aspects(format), 0, VK_REMAINING_MIP_LEVELS, 0, VK_REMAINING_ARRAY_LAYERS};
    VkDependencyInfo dependency{};
    dependency.sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO;
    dependency.imageMemoryBarrierCount = 1;
    dependency.pImageMemoryBarriers = &barrier;
    vkCmdPipelineBarrier2(commands, &dependency);
}

void clear_image(VkCommandBuffer commands, VkImage image, VkFormat format, const VkClearValue& value,
                 VkImageLayout layout) {
    constexpr VkImageLayout target = VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL;
    transition(commands, image, format, VK_IMAGE_LAYOUT_UNDEFINED, target);
    const VkImageSubresourceRange range{gpu::format_aspects(format), 0, VK_REMAINING_MIP_LEVELS, 0,
                                        VK_REMAINING_ARRAY_LAYERS};
    if (is_depth_stencil(format)) {
        vkCmdClearDepthStencilImage(commands, image, target, &value.depthStencil, 1, &range);
    } else {
        vkCmdClearColorImage(commands, image, target, &value.color, 1, &range);
    }
    transition(commands, image, format, target, layout);
}

void clear_buffer(VkCommandBuffer commands, VkBuffer buffer) {
    VkMemoryBarrier2 barrier{};
    barrier.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER_2;
    barrier.srcStageMask = barrier.dstStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
    barrier.srcAccessMask = VK_ACCESS_2_MEMORY_WRITE_BIT;
    barrier.dstAccessMask = kEveryAccess;
    VkDependencyInfo dependency{};
    dependency.sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO;
    dependency.memoryBarrierCount = 1;
    dependency.pMemoryBarriers = &barrier;
    vkCmdPipelineBarrier2(commands, &dependency);
    vkCmdFillBuffer(commands, buffer, 0, VK_WHOLE_SIZE, 0);
    vkCmdPipelineBarrier2(commands, &dependency);
}

}  // namespace

void Histories::begin_frame(std::span<BoundResource> bound) {
    side_ = 1 - side_;
    for (const Pair& pair : pairs_) {
        bound[pair.previous] = pair.sides[side_];
        bound[pair.previous + 1] = pair.sides[1 - side_];
    }
}

void Histories::reset(VkCommandBuffer commands, const Graph& graph, const Plan& plan) const {
    for (const Pair& pair : pairs_) {
        if (plan.resources[pair.previous].lifetime.first_group == none) continue;
        const ResourceDeclaration& declared = graph.declaration().resources[pair.previous];
        const BoundResource& real = pair.sides[side_];
        if (declared.kind == ResourceKind::buffer) {
            clear_buffer(commands, real.buffer);
        } else {
            clear_image(commands, real.image.image, declared.image.format, graph.initial_value(pair.previous),
                        plan.resources[pair.previous].initial_layout);
        }
    }
}

}  // namespace splice::graph
