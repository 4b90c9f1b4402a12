#include "engine/bench/graph/hand_written_step.h"

namespace splice::bench {

void HandStep::record(VkCommandBuffer commands) const {
    record_barriers(commands, barriers);
    VkRenderPassBeginInfo begin{};
    begin.sType = VK_STRUCTURE_TYPE_RENDER_PASS_BEGIN_INFO;
    begin.renderPass = render_pass.get();
    begin.framebuffer = framebuffer.get();
    begin.renderArea.extent = extent;
    begin.clearValueCount = static_cast<uint32_t>(clear_values.size());
    begin.pClearValues = clear_values.data();
    vkCmdBeginRenderPass(commands, &begin, VK_SUBPASS_CONTENTS_INLINE);
    const VkViewport viewport{0, 0, static_cast<float>(extent.width), static_cast<float>(extent.height), 0, 1};
    const VkRect2D scissor{{0, 0}, extent};
    for (const HandSubpass& subpass : subpasses) {
        if (&subpass != &subpasses.front()) vkCmdNextSubpass(commands, VK_SUBPASS_CONTENTS_INLINE);
        vkCmdSetViewport(commands, 0, 1, &viewport);
        vkCmdSetScissor(commands, 0, 1, &scissor);
        vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, subpass.pipeline.handle());
        vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, subpass.layout, 0, 1, &subpass.set, 0,
                                nullptr);
        draw_rectangles(commands, subpass.layout, subpass.draws);
    }
    vkCmdEndRenderPass(commands);
}

uint32_t HandStep::commands() const {
    constexpr uint32_t kBarrierBeginEnd = 3, kStateOfSubpass = 5, kDraw = 2;
    auto count = kBarrierBeginEnd + kStateOfSubpass * static_cast<uint32_t>(subpasses.size()) - 1;
    for (const HandSubpass& subpass : subpasses)
        count += kDraw * static_cast<uint32_t>(subpass.draws.size());
    return count;
}

void record_barriers(VkCommandBuffer commands, const std::vector<VkImageMemoryBarrier2>& barriers) {
    VkDependencyInfo dependency{};
    dependency.sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO;
    dependency.imageMemoryBarrierCount = static_cast<uint32_t>(barriers.size());
    dependency.pImageMemoryBarriers = barriers.data();
    vkCmdPipelineBarrier2(commands, &dependency);
}

VkImageMemoryBarrier2 hand_barrier(const gpu::Image& image, HandScope source, HandScope destination,
                                   VkImageLayout old_layout, VkImageLayout new_layout) {
    VkImageMemoryBarrier2 barrier{};
    barrier.sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2;
    barrier.srcStageMask = source.stages;
    barrier.srcAccessMask = source.access;
    barrier.dstStageMask = destination.stages;
    barrier.dstAccessMask = destination.access;
    barrier.oldLayout = old_layout;
    barrier.newLayout = new_layout;
    barrier.srcQueueFamilyIndex = barrier.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
    barrier.image = image.handle();
    barrier.subresourceRange = {gpu::format_aspects(image.options().format), 0, 1, 0, 1};
    return barrier;
}

gpu::UniqueRenderPass hand_render_pass(const gpu::Device& device, const std::vector<HandAttachment>& attachments,
                                       const std::vector<HandSubpassAttachments>& subpasses,
                                       const std::vector<VkSubpassDependency2>& dependencies) {
    std::vector<VkAttachmentDescription2> descriptions;
    for (const HandAttachment& attachment : attachments) {
        VkAttachmentDescription2 description{};
        description.sType = VK_STRUCTURE_TYPE_ATTACHMENT_DESCRIPTION_2;
        description.format = attachment.image->options().format;
        description.samples = VK_SAMPLE_COUNT_1_BIT;
        description.loadOp = attachment.load;
        description.storeOp = attachment.store;
        description.stencilLoadOp = VK_ATTACHMENT_LOAD_OP_DONT_CARE;
        description.stencilStoreOp = VK_ATTACHMENT_STORE_OP_DONT_CARE;
        description.initialLayout = attachment.initial_layout;
        description.finalLayout = attachment.final_layout;
        descriptions.push_back(description);
    }
    const auto aspects_of = [&](uint32_t index) {
        return gpu::format_aspects(attachments[index].image->options().format);
    };
    std::vector<std::vector<VkAttachmentReference2>> references;  // colours, inputs and depth of each subpass
    const auto refer = [&](uint32_t index, VkImageLayout layout) {
        VkAttachmentReference2 reference{};
        reference.sType = VK_STRUCTURE_TYPE_ATTACHMENT_REFERENCE_2;
        reference.attachment = index;
        reference.layout = layout;
        reference.aspectMask = aspects_of(index);
        references.back().push_back(reference);
    };
    std::vector<VkSubpassDescription2> described;
    for (const HandSubpassAttachments& subpass : subpasses) {
        VkSubpassDescription2 description{};
        description.sType = VK_STRUCTURE_TYPE_SUBPASS_DESCRIPTION_2;
        description.pipelineBindPoint = VK_PIPELINE_BIND_POINT_GRAPHICS;
        references.emplace_back();
        for (const uint32_t index : subpass.colours)
            refer(index, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL);
        for (const uint32_t index : subpass.inputs) {
            const bool depth = aspects_of(index) == VK_IMAGE_ASPECT_DEPTH_BIT;
            refer(index,
                  depth ? VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL : VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
        }
        if (subpass.depth >= 0)
            refer(static_cast<uint32_t>(subpass.depth), VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL);
        const VkAttachmentReference2* first = references.back().data();
        description.colorAttachmentCount = static_cast<uint32_t>(subpass.colours.size());
        description.pColorAttachments = first;
        description.inputAttachmentCount = static_cast<uint32_t>(subpass.inputs.size());
        description.pInputAttachments = first + subpass.colours.size();
        if (subpass.depth >= 0)
            description.pDepthStencilAttachment = first + subpass.colours.size() + subpass.inputs.size();
        described.push_back(description);
    }
    VkRenderPassCreateInfo2 info{};
    info.sType = VK_STRUCTURE_TYPE_RENDER_PASS_CREATE_INFO_2;
    info.attachmentCount = static_cast<uint32_t>(descriptions.size());
    info.pAttachments = descriptions.data();
    info.subpassCount = static_cast<uint32_t>(described.size());
    info.pSubpasses = described.data();
    info.dependencyCount = static_cast<uint32_t>(dependencies.size());
    info.pDependencies = dependencies.data();
    VkRenderPass handle = VK_NULL_HANDLE;
    gpu::check(vkCreateRenderPass2(device.handle(), &info, nullptr, &handle), "creating a render pass");
    return {device.handle(), handle};
}

VkSubpassDependency2 hand_dependency(uint32_t source, uint32_t destination, HandScope before, HandScope after) {
    VkSubpassDependency2 dependency{};
    dependency.sType = VK_STRUCTURE_TYPE_SUBPASS_DEPENDENCY_2;
    dependency.srcSubpass = source;
    dependency.dstSubpass = destination;
    dependency.srcStageMask = static_cast<VkPipelineStageFlags>(before.stages);
    dependency.dstStageMask = static_cast<VkPipelineStageFlags>(after.stages);
    dependency.srcAccessMask = static_cast<VkAccessFlags>(before.access);
    dependency.dstAccessMask = static_cast<VkAccessFlags>(after.access);
    dependency.dependencyFlags = VK_DEPENDENCY_BY_REGION_BIT;
    return dependency;
}

gpu::UniqueFramebuffer hand_framebuffer(const gpu::Device& device, VkRenderPass render_pass,
                                        const std::vector<HandAttachment>& attachments) {
    std::vector<VkImageView> views;
    for (const HandAttachment& attachment : attachments)
        views.push_back(attachment.image->view());
    VkFramebufferCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_FRAMEBUFFER_CREATE_INFO;
    info.renderPass = render_pass;
    info.attachmentCount = static_cast<uint32_t>(views.size());
    info.pAttachments = views.data();
    info.width = attachments.front().image->options().width;
    info.height = attachments.front().image->options().height;
    info.layers = 1;
    VkFramebuffer handle = VK_NULL_HANDLE;
    gpu::check(vkCreateFramebuffer(device.handle(), &info, nullptr, &handle), "creating a framebuffer");
    return {device.handle(), handle};
}

}  // namespace splice::bench
