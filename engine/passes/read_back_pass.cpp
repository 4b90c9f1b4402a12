#include "engine/passes/read_back_pass.h"

#include "engine/render_graph/executor/pass_context.h"

namespace splice {

void add_read_back(graph::Graph& graph, graph::ImageHandle picture, graph::BufferHandle destination,
                   std::uint32_t width, std::uint32_t height) {
    graph::Pass pass = graph.add_pass("read_back", graph::PassKind::transfer);
    pass.transfer_read(picture);
    pass.transfer_write(destination, graph::Contents::discard());
    pass.record([=](const graph::PassContext& context) {
        VkBufferImageCopy region{};
        region.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
        region.imageExtent = {width, height, 1};
        vkCmdCopyImageToBuffer(context.commands, context.image(picture), VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL,
                               context.buffer(destination), 1, &region);
    });
}

}  // namespace splice
