#include "engine/bench/graph/device_graph.h"

#include "engine/vulkan/transfer.h"

#include <utility>

namespace splice::bench {

DeviceGraph::DeviceGraph(gpu::Device& device, std::function<void(graph::Graph&)> declare,
                         const graph::ExecutorOptions& options)
    : device_(&device), declare_(std::move(declare)), executor_(device, options) {
    declare_(graph_);
    for (uint32_t resource = 0; resource < graph_.declaration().resources.size(); ++resource) {
        if (graph_.declaration().resources[resource].imported) create_imported(resource);
    }
}

void DeviceGraph::create_imported(uint32_t resource) {
    const graph::ResourceDeclaration& declared = graph_.declaration().resources[resource];
    if (declared.kind == graph::ResourceKind::image) {
        images_.emplace_back(
            *device_, gpu::ImageOptions{.format = declared.image.format,
                                        .width = declared.image.width,
                                        .height = declared.image.height,
                                        .usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT,
                                        .name = graph_.resource_name(resource)});
        bindings_.bind(graph_.image(resource), images_.back());
        return;
    }
    buffers_.emplace_back(*device_, gpu::BufferOptions{.size = declared.buffer.size,
                                                       .usage = VK_BUFFER_USAGE_TRANSFER_DST_BIT,
                                                       .memory = gpu::MemoryUse::readback,
                                                       .name = graph_.resource_name(resource)});
    bindings_.bind(graph_.buffer(resource), buffers_.back());
}

std::vector<std::byte> DeviceGraph::results() {
    std::vector<std::byte> all;
    for (const gpu::Image& image : images_) {
        const std::vector<std::byte> bytes = gpu::read_back(*device_, image, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL);
        all.insert(all.end(), bytes.begin(), bytes.end());
    }
    for (const gpu::Buffer& buffer : buffers_) {
        const std::span<const std::byte> bytes = buffer.mapped();
        all.insert(all.end(), bytes.begin(), bytes.end());
    }
    return all;
}

}  // namespace splice::bench
