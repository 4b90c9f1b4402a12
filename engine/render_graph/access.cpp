#include "engine/render_graph/access.h"

namespace splice::graph {

bool is_write(AccessKind kind) {
    switch (kind) {
        case AccessKind::colour_attachment:
        case AccessKind::depth_stencil_attachment:
        case AccessKind::storage_write:
        case AccessKind::storage_read_write:
        case AccessKind::transfer_write:
            return true;
        default:
            return false;
    }
}

bool is_attachment(AccessKind kind) {
    switch (kind) {
        case AccessKind::colour_attachment:
        case AccessKind::depth_stencil_attachment:
        case AccessKind::depth_stencil_read:
        case AccessKind::input_attachment:
            return true;
        default:
            return false;
    }
}

VkImageAspectFlags aspects_of(VkFormat format) {
    switch (format) {
        case VK_FORMAT_D16_UNORM:
        case VK_FORMAT_X8_D24_UNORM_PACK32:
        case VK_FORMAT_D32_SFLOAT:
            return VK_IMAGE_ASPECT_DEPTH_BIT;
        case VK_FORMAT_S8_UINT:
            return VK_IMAGE_ASPECT_STENCIL_BIT;
        case VK_FORMAT_D16_UNORM_S8_UINT:
        case VK_FORMAT_D24_UNORM_S8_UINT:
        case VK_FORMAT_D32_SFLOAT_S8_UINT:
            return VK_IMAGE_ASPECT_DEPTH_BIT | VK_IMAGE_ASPECT_STENCIL_BIT;
        default:
            return VK_IMAGE_ASPECT_COLOR_BIT;
    }
}

bool is_depth_stencil(VkFormat format) {
    return aspects_of(format) != VK_IMAGE_ASPECT_COLOR_BIT;
}

const char* describe(AccessKind kind) {
    switch (kind) {
        case AccessKind::colour_attachment:
            return "a colour attachment";
        case AccessKind::depth_stencil_attachment:
            return "a depth-stencil attachment";
        case AccessKind::depth_stencil_read:
            return "a read-only depth-stencil attachment";
        case AccessKind::input_attachment:
            return "an input attachment";
        case AccessKind::sampled:
            return "a sampled image";
        case AccessKind::storage_read:
            return "storage that is read";
        case AccessKind::storage_write:
            return "storage that is written";
        case AccessKind::storage_read_write:
            return "storage that is read and written";
        case AccessKind::uniform:
            return "a uniform buffer";
        case AccessKind::vertex:
            return "a vertex buffer";
        case AccessKind::index:
            return "an index buffer";
        case AccessKind::indirect:
            return "an indirect buffer";
        case AccessKind::transfer_read:
            return "the source of a transfer";
        case AccessKind::transfer_write:
            return "the target of a transfer";
    }
    return "";
}

const char* describe(PassKind kind) {
    switch (kind) {
        case PassKind::graphics:
            return "graphics";
        case PassKind::compute:
            return "compute";
        case PassKind::transfer:
            return "transfer";
    }
    return "";
}

Scope scope_of(AccessKind kind, VkPipelineStageFlags shader_stages) {
    constexpr VkPipelineStageFlags tests =
        VK_PIPELINE_STAGE_EARLY_FRAGMENT_TESTS_BIT | VK_PIPELINE_STAGE_LATE_FRAGMENT_TESTS_BIT;
    switch (kind) {
        // Reading belongs to every colour attachment: a pass may blend, and the graph does not know.
        case AccessKind::colour_attachment:
            return {VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT,
                    VK_ACCESS_COLOR_ATTACHMENT_READ_BIT | VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT};
        case AccessKind::depth_stencil_attachment:
            return {tests, VK_ACCESS_DEPTH_STENCIL_ATTACHMENT_READ_BIT | VK_ACCESS_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT};
        case AccessKind::depth_stencil_read:
            return {tests, VK_ACCESS_DEPTH_STENCIL_ATTACHMENT_READ_BIT};
        case AccessKind::input_attachment:
            return {VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT, VK_ACCESS_INPUT_ATTACHMENT_READ_BIT};
        case AccessKind::sampled:
        case AccessKind::storage_read:
            return {shader_stages, VK_ACCESS_SHADER_READ_BIT};
        case AccessKind::storage_write:
            return {shader_stages, VK_ACCESS_SHADER_WRITE_BIT};
        case AccessKind::storage_read_write:
            return {shader_stages, VK_ACCESS_SHADER_READ_BIT | VK_ACCESS_SHADER_WRITE_BIT};
        case AccessKind::uniform:
            return {shader_stages, VK_ACCESS_UNIFORM_READ_BIT};
        case AccessKind::vertex:
            return {VK_PIPELINE_STAGE_VERTEX_INPUT_BIT, VK_ACCESS_VERTEX_ATTRIBUTE_READ_BIT};
        case AccessKind::index:
            return {VK_PIPELINE_STAGE_VERTEX_INPUT_BIT, VK_ACCESS_INDEX_READ_BIT};
        case AccessKind::indirect:
            return {VK_PIPELINE_STAGE_DRAW_INDIRECT_BIT, VK_ACCESS_INDIRECT_COMMAND_READ_BIT};
        case AccessKind::transfer_read:
            return {VK_PIPELINE_STAGE_TRANSFER_BIT, VK_ACCESS_TRANSFER_READ_BIT};
        case AccessKind::transfer_write:
            return {VK_PIPELINE_STAGE_TRANSFER_BIT, VK_ACCESS_TRANSFER_WRITE_BIT};
    }
    return {};
}

Scope load_scope(VkFormat format, VkAttachmentLoadOp load) {
    const bool reads = load == VK_ATTACHMENT_LOAD_OP_LOAD;
    if (is_depth_stencil(format)) {
        return {VK_PIPELINE_STAGE_EARLY_FRAGMENT_TESTS_BIT,
                reads ? VK_ACCESS_DEPTH_STENCIL_ATTACHMENT_READ_BIT : VK_ACCESS_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT};
    }
    return {VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT,
            reads ? VK_ACCESS_COLOR_ATTACHMENT_READ_BIT : VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT};
}

Scope store_scope(VkFormat format, VkAttachmentStoreOp store) {
    if (store == VK_ATTACHMENT_STORE_OP_NONE) return {};
    if (is_depth_stencil(format)) {
        return {VK_PIPELINE_STAGE_LATE_FRAGMENT_TESTS_BIT, VK_ACCESS_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT};
    }
    return {VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT, VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT};
}

VkImageLayout layout_of(AccessKind kind, VkFormat format) {
    if (format == VK_FORMAT_UNDEFINED) return VK_IMAGE_LAYOUT_UNDEFINED;
    switch (kind) {
        case AccessKind::colour_attachment:
            return VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL;
        case AccessKind::depth_stencil_attachment:
            return VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL;
        case AccessKind::depth_stencil_read:
            return VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL;
        case AccessKind::input_attachment:
        case AccessKind::sampled:
            return is_depth_stencil(format) ? VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL
                                            : VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;
        case AccessKind::storage_read:
        case AccessKind::storage_write:
        case AccessKind::storage_read_write:
            return VK_IMAGE_LAYOUT_GENERAL;
        case AccessKind::transfer_read:
            return VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL;
        case AccessKind::transfer_write:
            return VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL;
        default:
            return VK_IMAGE_LAYOUT_UNDEFINED;  // buffers have none
    }
}

VkImageUsageFlags image_usage(AccessKind kind) {
    switch (kind) {
        case AccessKind::colour_attachment:
            return VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT;
        case AccessKind::depth_stencil_attachment:
        case AccessKind::depth_stencil_read:
            return VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT;
        case AccessKind::input_attachment:
            return VK_IMAGE_USAGE_INPUT_ATTACHMENT_BIT;
        case AccessKind::sampled:
            return VK_IMAGE_USAGE_SAMPLED_BIT;
        case AccessKind::storage_read:
        case AccessKind::storage_write:
        case AccessKind::storage_read_write:
            return VK_IMAGE_USAGE_STORAGE_BIT;
        case AccessKind::transfer_read:
            return VK_IMAGE_USAGE_TRANSFER_SRC_BIT;
        case AccessKind::transfer_write:
            return VK_IMAGE_USAGE_TRANSFER_DST_BIT;
        default:
            return 0;
    }
}

VkBufferUsageFlags buffer_usage(AccessKind kind) {
    switch (kind) {
        case AccessKind::storage_read:
        case AccessKind::storage_write:
        case AccessKind::storage_read_write:
            return VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;
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
            return 0;
    }
}

VkAccessFlags write_access(VkAccessFlags access) {
    return access & (VK_ACCESS_SHADER_WRITE_BIT | VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT |
                     VK_ACCESS_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT | VK_ACCESS_TRANSFER_WRITE_BIT |
                     VK_ACCESS_HOST_WRITE_BIT | VK_ACCESS_MEMORY_WRITE_BIT);
}

}  // namespace splice::graph
