#include "tests/render_graph/access_model.h"

#include <algorithm>

namespace splice::test {

using graph::AccessKind;

std::vector<Step> shader_steps(VkPipelineStageFlags stages, VkAccessFlags reads, VkAccessFlags writes) {
    std::vector<Step> steps;
    for (VkPipelineStageFlags bit = 1; bit != 0; bit <<= 1) {
        if ((stages & bit) != 0) steps.push_back({bit, reads, writes});
    }
    return steps;
}

std::vector<Step> steps_of(const graph::Access& access) {
    constexpr VkAccessFlags shader_read = VK_ACCESS_SHADER_READ_BIT, shader_write = VK_ACCESS_SHADER_WRITE_BIT;
    constexpr VkAccessFlags depth_read = VK_ACCESS_DEPTH_STENCIL_ATTACHMENT_READ_BIT;
    constexpr VkAccessFlags depth_write = VK_ACCESS_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT;
    switch (access.kind) {
        case AccessKind::colour_attachment:
            return {{kColour, VK_ACCESS_COLOR_ATTACHMENT_READ_BIT, VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT}};
        case AccessKind::depth_stencil_attachment:
            return {{kEarly, depth_read, depth_write}, {kLate, depth_read, depth_write}};
        case AccessKind::depth_stencil_read:
            return {{kEarly, depth_read, 0}, {kLate, depth_read, 0}};
        case AccessKind::input_attachment:
            return {{kFragment, VK_ACCESS_INPUT_ATTACHMENT_READ_BIT, 0}};
        case AccessKind::sampled:
        case AccessKind::storage_read:
            return shader_steps(access.stages, shader_read, 0);
        case AccessKind::storage_write:
            return shader_steps(access.stages, 0, shader_write);
        case AccessKind::storage_read_write:
            return shader_steps(access.stages, shader_read, shader_write);
        case AccessKind::uniform:
            return shader_steps(access.stages, VK_ACCESS_UNIFORM_READ_BIT, 0);
        case AccessKind::vertex:
            return {{VK_PIPELINE_STAGE_VERTEX_INPUT_BIT, VK_ACCESS_VERTEX_ATTRIBUTE_READ_BIT, 0}};
        case AccessKind::index:
            return {{VK_PIPELINE_STAGE_VERTEX_INPUT_BIT, VK_ACCESS_INDEX_READ_BIT, 0}};
        case AccessKind::indirect:
            return {{VK_PIPELINE_STAGE_DRAW_INDIRECT_BIT, VK_ACCESS_INDIRECT_COMMAND_READ_BIT, 0}};
        case AccessKind::transfer_read:
            return {{VK_PIPELINE_STAGE_TRANSFER_BIT, VK_ACCESS_TRANSFER_READ_BIT, 0}};
        case AccessKind::transfer_write:
            return {{VK_PIPELINE_STAGE_TRANSFER_BIT, 0, VK_ACCESS_TRANSFER_WRITE_BIT}};
    }
    return {};
}

bool writes(const std::vector<Step>& steps) {
    return std::any_of(steps.begin(), steps.end(), [](const Step& step) { return step.writes != 0; });
}

bool has_depth(VkFormat format) {
    return format == VK_FORMAT_D32_SFLOAT || format == VK_FORMAT_D32_SFLOAT_S8_UINT || format == VK_FORMAT_D16_UNORM ||
           format == VK_FORMAT_D24_UNORM_S8_UINT;
}

bool has_stencil(VkFormat format) {
    return format == VK_FORMAT_D32_SFLOAT_S8_UINT || format == VK_FORMAT_D24_UNORM_S8_UINT;
}

VkImageAspectFlags aspects_of(VkFormat format) {
    if (!has_depth(format)) return VK_IMAGE_ASPECT_COLOR_BIT;
    return VK_IMAGE_ASPECT_DEPTH_BIT | (has_stencil(format) ? VkImageAspectFlags{VK_IMAGE_ASPECT_STENCIL_BIT} : 0);
}

bool used_as_attachment(AccessKind kind) {
    return kind == AccessKind::colour_attachment || kind == AccessKind::depth_stencil_attachment ||
           kind == AccessKind::depth_stencil_read || kind == AccessKind::input_attachment;
}

VkImageUsageFlags image_usage_of(AccessKind kind, VkFormat format) {
    // An image in the read-only layout of depth must have been created as an attachment (valid usage of barriers).
    const VkImageUsageFlags read_only = has_depth(format) ? VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT : 0;
    switch (kind) {
        case AccessKind::colour_attachment:
            return VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT;
        case AccessKind::depth_stencil_attachment:
        case AccessKind::depth_stencil_read:
            return VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT;
        case AccessKind::input_attachment:
            return VK_IMAGE_USAGE_INPUT_ATTACHMENT_BIT | read_only;
        case AccessKind::sampled:
            return VK_IMAGE_USAGE_SAMPLED_BIT | read_only;
        case AccessKind::transfer_read:
            return VK_IMAGE_USAGE_TRANSFER_SRC_BIT;
        case AccessKind::transfer_write:
            return VK_IMAGE_USAGE_TRANSFER_DST_BIT;
        default:
            return VK_IMAGE_USAGE_STORAGE_BIT;
    }
}

VkBufferUsageFlags buffer_usage_of(AccessKind kind) {
    switch (kind) {
        case AccessKind::uniform:
            return VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT;
        case AccessKind::vertex:
            return VK_BUFFER_USAGE_VERTEX_BUFFER_BIT;
        case AccessKind::index:
            return VK_BUFFER_USAGE_INDEX_BUFFER_BIT;
        case AccessKind::indirect:
            return VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT;
        case AccessKind::transfer_read:
            return VK_BUFFER_USAGE_TRANSFER_SRC_BIT;
        case AccessKind::transfer_write:
            return VK_BUFFER_USAGE_TRANSFER_DST_BIT;
        default:
            return VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;
    }
}

bool layout_fits(VkImageLayout layout, AccessKind kind, VkFormat format) {
    switch (kind) {
        case AccessKind::colour_attachment:
            return layout == VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL;
        case AccessKind::depth_stencil_attachment:
            return layout == VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL;
        case AccessKind::depth_stencil_read:
            return layout == VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL;
        case AccessKind::input_attachment:
        case AccessKind::sampled:
            return layout == (has_depth(format) ? VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL
                                                : VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);
        case AccessKind::transfer_read:
            return layout == VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL;
        case AccessKind::transfer_write:
            return layout == VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL;
        default:
            return layout == VK_IMAGE_LAYOUT_GENERAL;
    }
}

Step load_step(VkFormat format, VkAttachmentLoadOp load) {
    const bool reads = load == VK_ATTACHMENT_LOAD_OP_LOAD;
    if (has_depth(format)) {
        return {kEarly, reads ? VkAccessFlags{VK_ACCESS_DEPTH_STENCIL_ATTACHMENT_READ_BIT} : 0,
                reads ? 0 : VkAccessFlags{VK_ACCESS_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT}};
    }
    return {kColour, reads ? VkAccessFlags{VK_ACCESS_COLOR_ATTACHMENT_READ_BIT} : 0,
            reads ? 0 : VkAccessFlags{VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT}};
}

bool Atom::ordered_before(VkPipelineStageFlags stages) const {
    if (((stage | after | chained) & stages) != 0) return true;
    return std::any_of(after_in.begin(), after_in.end(), [&](const auto& in) { return (in.second & stages) != 0; });
}

bool Atom::ordered(VkPipelineStageFlags stage_after, uint32_t in_subpass) const {
    if ((after & stage_after) != 0) return true;
    const auto in = after_in.find(in_subpass);
    return in != after_in.end() && (in->second & stage_after) != 0;
}

bool Atom::seen_by(const Step& step, uint32_t in_subpass) const {
    if (!available) return false;
    VkAccessFlags seen = 0;
    if (const auto at = visible.find(step.stage); at != visible.end()) seen |= at->second;
    if (const auto in = visible_in.find(in_subpass); in != visible_in.end()) {
        if (const auto at = in->second.find(step.stage); at != in->second.end()) seen |= at->second;
    }
    return ((step.reads | step.writes) & ~seen) == 0;
}

void Atom::extend(const graph::Scope& source, const graph::Scope& destination) {
    if (!ordered_before(source.stages)) return;
    if (writes != 0 && (stage & source.stages) != 0 && (writes & ~source.access) == 0) available = true;
    after |= destination.stages;
    if (!available) return;
    for (const Step& step : shader_steps(destination.stages, 0, 0)) {
        visible[step.stage] |= destination.access;
    }
}

void Atom::extend(const graph::SubpassDependency& dependency) {
    const VkPipelineStageFlags source = dependency.source_scope.stages;
    const auto in = after_in.find(dependency.source);
    const bool own = subpass == dependency.source && (stage & source) != 0;
    const bool chain = in != after_in.end() && (in->second & source) != 0;
    if (!own && !chain) return;
    if (own && writes != 0 && (writes & ~dependency.source_scope.access) == 0) available = true;
    const graph::Scope& destination = dependency.destination_scope;
    after_in[dependency.destination] |= destination.stages;
    if (!available) return;
    for (const Step& step : shader_steps(destination.stages, 0, 0)) {
        visible_in[dependency.destination][step.stage] |= destination.access;
    }
}

void Atom::leave_render_pass() {
    subpass = graph::none;
    for (const auto& [in, stages] : after_in)
        chained |= stages;
    after_in.clear();
    visible_in.clear();
}

}  // namespace splice::test
