#include "engine/passes/copy_pass.h"

#include "engine/render_graph/executor/pass_context.h"

namespace splice {

void add_copy(graph::Graph& graph, graph::ImageHandle picture, graph::ImageHandle destination, std::uint32_t width,
              std::uint32_t height) {
    graph::Pass pass = graph.add_pass("copy", graph::PassKind::transfer);
    pass.transfer_read(picture);
    pass.transfer_write(destination, graph::Contents::discard());
    pass.record([=](const graph::PassContext& context) {
        VkImageCopy region{};
        region.srcSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
        region.dstSubresource = region.srcSubresource;
        region.extent = {width, height, 1};
        vkCmdCopyImage(context.commands, context.image(picture), VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL,
                       context.image(destination), VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &region);
    });
}

}  // namespace splice
