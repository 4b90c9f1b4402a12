#include "engine/render_graph/access.h"

namespace splice::graph {

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

}  // namespace splice::graph
