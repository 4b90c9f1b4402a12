#include "engine/render_graph/executor/render_pass_cache.h"

#include <cstddef>
#include <span>

namespace splice::graph {
namespace {

VkAttachmentDescription2 describe_attachment(const Declaration& declaration, const Attachment& attachment) {
    const ImageDescription& image = declaration.resources[attachment.resource].image;
    VkAttachmentDescription2 description{};
    description.sType = VK_STRUCTURE_TYPE_ATTACHMENT_DESCRIPTION_2;
    description.format = image.format;
    description.samples = image.samples;
    description.loadOp = attachment.load;
    description.storeOp = attachment.store;
    description.stencilLoadOp = attachment.stencil_load;
    description.stencilStoreOp = attachment.stencil_store;
    description.initialLayout = attachment.initial_layout;
    description.finalLayout = attachment.final_layout;
    return description;
}

VkAttachmentReference2 describe_reference(const AttachmentReference& reference) {
    VkAttachmentReference2 description{};
    description.sType = VK_STRUCTURE_TYPE_ATTACHMENT_REFERENCE_2;
    description.attachment = reference.attachment;
    description.layout = reference.layout;
    description.aspectMask = reference.aspects;
    return description;
}

VkSubpassDependency2 describe_dependency(const SubpassDependency& dependency) {
    VkSubpassDependency2 description{};
    description.sType = VK_STRUCTURE_TYPE_SUBPASS_DEPENDENCY_2;
    description.srcSubpass = dependency.source;
    description.dstSubpass = dependency.destination;
    description.srcStageMask = dependency.source_scope.stages;
    description.dstStageMask = dependency.destination_scope.stages;
    description.srcAccessMask = dependency.source_scope.access;
    description.dstAccessMask = dependency.destination_scope.access;
    description.dependencyFlags = VK_DEPENDENCY_BY_REGION_BIT;
    return description;
}

/// Everything that distinguishes two render passes, as numbers.
std::vector<uint32_t> key_of(const Declaration& declaration, const Plan& plan, const RenderPass& render_pass) {
    std::vector<uint32_t> key;
    const auto add = [&](auto... values) { (key.push_back(static_cast<uint32_t>(values)), ...); };
    const auto add_references = [&](Range range) {
        add(range.count);
        for (const AttachmentReference& reference : slice(plan.references, range)) {
            add(reference.attachment, reference.layout, reference.aspects);
        }
    };
    add(render_pass.attachments.count, render_pass.subpasses.count, render_pass.dependencies.count);
    for (const Attachment& attachment : slice(plan.attachments, render_pass.attachments)) {
        const ImageDescription& image = declaration.resources[attachment.resource].image;
        add(image.format, image.samples, attachment.load, attachment.store, attachment.stencil_load,
            attachment.stencil_store, attachment.initial_layout, attachment.final_layout);
    }
    for (const Subpass& subpass : slice(plan.subpasses, render_pass.subpasses)) {
        add_references(subpass.colours);
        add_references(subpass.inputs);
        add_references(subpass.depth_stencil);
        add(subpass.preserved.count);
        for (const uint32_t attachment : slice(plan.preserved, subpass.preserved))
            add(attachment);
    }
    for (const SubpassDependency& dependency : slice(plan.dependencies, render_pass.dependencies)) {
        add(dependency.source, dependency.destination, dependency.source_scope.stages, dependency.source_scope.access,
            dependency.destination_scope.stages, dependency.destination_scope.access);
    }
    return key;
}

gpu::UniqueRenderPass create(const gpu::Device& device, const Declaration& declaration, const Plan& plan,
                             const RenderPass& render_pass) {
    std::vector<VkAttachmentDescription2> attachments;
    for (const Attachment& attachment : slice(plan.attachments, render_pass.attachments)) {
        attachments.push_back(describe_attachment(declaration, attachment));
    }
    const std::span<const Subpass> planned = slice(plan.subpasses, render_pass.subpasses);
    size_t reference_count = 0;
    for (const Subpass& subpass : planned) {
        reference_count += size_t{subpass.colours.count} + subpass.inputs.count + subpass.depth_stencil.count;
    }
    std::vector<VkAttachmentReference2> references;
    references.reserve(reference_count);  // the subpasses point into it
    const auto add_references = [&](Range range) -> const VkAttachmentReference2* {
        const size_t first = references.size();
        for (const AttachmentReference& reference : slice(plan.references, range)) {
            references.push_back(describe_reference(reference));
        }
        return range.count > 0 ? references.data() + first : nullptr;
    };
    std::vector<VkSubpassDescription2> subpasses;
    for (const Subpass& subpass : planned) {
        VkSubpassDescription2 description{};
        description.sType = VK_STRUCTURE_TYPE_SUBPASS_DESCRIPTION_2;
        description.pipelineBindPoint = VK_PIPELINE_BIND_POINT_GRAPHICS;
        description.colorAttachmentCount = subpass.colours.count;
        description.pColorAttachments = add_references(subpass.colours);
        description.inputAttachmentCount = subpass.inputs.count;
        description.pInputAttachments = add_references(subpass.inputs);
        description.pDepthStencilAttachment = add_references(subpass.depth_stencil);
        description.preserveAttachmentCount = subpass.preserved.count;
        description.pPreserveAttachments = slice(plan.preserved, subpass.preserved).data();
        subpasses.push_back(description);
    }
    std::vector<VkSubpassDependency2> dependencies;
    for (const SubpassDependency& dependency : slice(plan.dependencies, render_pass.dependencies)) {
        dependencies.push_back(describe_dependency(dependency));
    }
    VkRenderPassCreateInfo2 info{};
    info.sType = VK_STRUCTURE_TYPE_RENDER_PASS_CREATE_INFO_2;
    info.attachmentCount = static_cast<uint32_t>(attachments.size());
    info.pAttachments = attachments.data();
    info.subpassCount = static_cast<uint32_t>(subpasses.size());
    info.pSubpasses = subpasses.data();
    info.dependencyCount = static_cast<uint32_t>(dependencies.size());
    info.pDependencies = dependencies.data();
    VkRenderPass handle = VK_NULL_HANDLE;
    gpu::check(vkCreateRenderPass2(device.handle(), &info, nullptr, &handle), "creating a render pass");
    return {device.handle(), handle};
}

}  // namespace

std::shared_ptr<const gpu::UniqueRenderPass> RenderPassCache::get(const Declaration& declaration, const Plan& plan,
                                                                  const RenderPass& render_pass) {
    std::shared_ptr<const gpu::UniqueRenderPass>& cached = render_passes_[key_of(declaration, plan, render_pass)];
    if (!cached) {
        cached = std::make_shared<const gpu::UniqueRenderPass>(create(*device_, declaration, plan, render_pass));
    }
    return cached;
}

}  // namespace splice::graph
