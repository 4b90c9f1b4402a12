#include "tests/render_graph/surfel_frame.h"

#include "shaders/divide_frag.h"
#include "shaders/flat_frag.h"
#include "shaders/full_screen_vert.h"

#include <array>
#include <cstring>
#include <span>

namespace splice::test {

using graph::Contents;

SurfelFrame::SurfelFrame(gpu::Device& device, uint32_t width, uint32_t height)
    : device_(&device),
      width_(width),
      height_(height),
      vertex_(device, full_screen_vert, "full_screen.vert"),
      flat_(device, flat_frag, "flat.frag"),
      divide_(device, divide_frag, "divide.frag"),
      set_layout_(device, {{0, VK_DESCRIPTOR_TYPE_INPUT_ATTACHMENT, VK_SHADER_STAGE_FRAGMENT_BIT},
                           {1, VK_DESCRIPTOR_TYPE_INPUT_ATTACHMENT, VK_SHADER_STAGE_FRAGMENT_BIT},
                           {2, VK_DESCRIPTOR_TYPE_INPUT_ATTACHMENT, VK_SHADER_STAGE_FRAGMENT_BIT}}),
      plain_layout_(device, {}, sizeof(Constants)),
      pool_(device),
      pixels_(device,
              {uint64_t{width} * height * 4, VK_BUFFER_USAGE_TRANSFER_DST_BIT, gpu::MemoryUse::readback, "pixels"}) {
    const std::array sets{set_layout_.handle()};
    divide_layout_ = gpu::PipelineLayout(device, sets, sizeof(Constants));
    set_ = pool_.allocate(set_layout_);
}

void SurfelFrame::draw(const graph::PassContext& context, graph::PassPipelines& pipelines, const Constants& constants,
                       const std::function<void(gpu::GraphicsPipelineOptions&)>& state, VkPipelineLayout layout,
                       const gpu::ShaderModule& fragment) {
    const VkPipeline pipeline = pipelines.get(*device_, context, [&] {
        gpu::GraphicsPipelineOptions options;
        options.vertex.module = &vertex_;
        options.fragment.module = &fragment;
        options.layout = layout;
        state(options);
        return options;
    });
    vkCmdBindPipeline(context.commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline);
    vkCmdPushConstants(context.commands, layout, VK_SHADER_STAGE_ALL, 0, sizeof(Constants), &constants);
    vkCmdDraw(context.commands, 3, 1, 0, 0);
}

void SurfelFrame::declare(graph::Graph& graph) {
    graph.clear();
    graph::ImageHandle colour = graph.create_image("colour", {VK_FORMAT_R8G8B8A8_UNORM, width_, height_});
    graph::ImageHandle depth = graph.create_image("depth", {device_->depth_stencil_format(), width_, height_});
    graph::ImageHandle accumulation =
        graph.create_image("accumulation", {VK_FORMAT_R32G32B32A32_SFLOAT, width_, height_});
    graph::ImageHandle picture = graph.create_image("picture", {VK_FORMAT_R8G8B8A8_UNORM, width_, height_});
    graph::ImportOptions import;
    import.after = graph::external::host_read();
    pixels_handle_ = graph.import_buffer("pixels", {pixels_.size()}, import);

    graph::Pass triangles = graph.add_pass("triangle", graph::PassKind::graphics);
    colour = triangles.colour_attachment(colour, Contents::clear(graph::clear_colour(0, 0, 0, 0)));
    depth = triangles.depth_stencil_attachment(depth, Contents::clear(graph::clear_depth_stencil(0, 0)));
    triangles.record([this](const graph::PassContext& context) {
        draw(
            context, triangle_, {{triangle_red, 0.4F, 0.6F, 1}, 0.4F},
            [](gpu::GraphicsPipelineOptions& options) {
                options.depth_test = options.depth_write = true;
                options.blends = {gpu::Blend::replace()};
            },
            plain_layout_.handle(), flat_);
    });

    if (surfels) {
        graph::Pass visibility = graph.add_pass("surfel_visibility", graph::PassKind::graphics);
        depth = visibility.depth_stencil_attachment(depth, Contents::keep());
        visibility.record([this](const graph::PassContext& context) {
            const VkRect2D left{{0, 0}, {width_ / 2, height_}};
            vkCmdSetScissor(context.commands, 0, 1, &left);
            draw(
                context, visibility_, {{0, 0, 0, 0}, 0.6F},
                [](gpu::GraphicsPipelineOptions& options) {
                    options.depth_test = options.depth_write = options.stencil_test = true;
                    options.stencil_front = options.stencil_back = {VK_STENCIL_OP_KEEP,
                                                                    VK_STENCIL_OP_REPLACE,
                                                                    VK_STENCIL_OP_KEEP,
                                                                    VK_COMPARE_OP_ALWAYS,
                                                                    0xFF,
                                                                    0xFF,
                                                                    1};
                    options.fragment.module = nullptr;
                },
                plain_layout_.handle(), flat_);
        });
    }

    graph::Pass attribute = graph.add_pass("surfel_attribute", graph::PassKind::graphics);
    accumulation = attribute.colour_attachment(accumulation, Contents::clear(graph::clear_colour(0, 0, 0, 0)));
    attribute.depth_stencil_read(depth);
    attribute.record([this](const graph::PassContext& context) {
        const auto state = [](gpu::GraphicsPipelineOptions& options) {
            options.depth_test = options.stencil_test = true;
            options.depth_compare = VK_COMPARE_OP_GREATER_OR_EQUAL;
            options.stencil_front = options.stencil_back = {
                VK_STENCIL_OP_KEEP, VK_STENCIL_OP_KEEP, VK_STENCIL_OP_KEEP, VK_COMPARE_OP_EQUAL, 0xFF, 0, 1};
            options.blends = {gpu::Blend::additive()};
        };
        draw(context, attribute_, {{0.5F, 0, 0, 0.5F}, 0.6F}, state, plain_layout_.handle(), flat_);
        draw(context, attribute_, {{0, 0, 0.25F, 0.25F}, 0.6F}, state, plain_layout_.handle(), flat_);
    });

    graph::Pass normalise = graph.add_pass("surfel_normalise", graph::PassKind::graphics);
    normalise.input_attachment(colour);
    normalise.input_attachment(accumulation);
    normalise.input_attachment(depth);
    normalise.depth_stencil_read(depth);
    picture = normalise.colour_attachment(picture, Contents::discard());
    normalise.record([this, colour, accumulation, depth](const graph::PassContext& context) {
        if (set_plan_ != context.plan_id) {
            gpu::DescriptorWriter(set_)
                .input_attachment(0, context.view(colour), VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL)
                .input_attachment(1, context.view(accumulation), VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL)
                .input_attachment(2, context.depth_view(depth), VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL)
                .write(*device_);
            set_plan_ = context.plan_id;
        }
        vkCmdBindDescriptorSets(context.commands, VK_PIPELINE_BIND_POINT_GRAPHICS, divide_layout_.handle(), 0, 1, &set_,
                                0, nullptr);
        draw(
            context, normalise_, {{0, 0, 0, 0}, 0.5F},
            [](gpu::GraphicsPipelineOptions& options) { options.blends = {gpu::Blend::replace()}; },
            divide_layout_.handle(), divide_);
    });

    graph::Pass copy = graph.add_pass("read_back", graph::PassKind::transfer);
    copy.transfer_read(picture);
    copy.transfer_write(pixels_handle_, Contents::discard());
    copy.record([this, picture, pixels = pixels_handle_](const graph::PassContext& context) {
        VkBufferImageCopy region{};
        region.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
        region.imageExtent = {width_, height_, 1};
        vkCmdCopyImageToBuffer(context.commands, context.image(picture), VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL,
                               context.buffer(pixels), 1, &region);
    });
}

void SurfelFrame::record(graph::Executor& executor, VkCommandBuffer commands, uint32_t frame_slot) {
    graph::Graph graph;
    declare(graph);
    graph::Bindings bindings;
    bindings.bind(pixels_handle_, pixels_);
    executor.execute(graph, bindings, commands, frame_slot);
}

std::vector<uint8_t> SurfelFrame::pixels() const {
    std::vector<uint8_t> bytes(pixels_.size());
    std::memcpy(bytes.data(), pixels_.mapped().data(), bytes.size());
    return bytes;
}

std::vector<uint8_t> SurfelFrame::run(graph::Executor& executor, uint32_t frame_slot) {
    device_->submit_and_wait([&](VkCommandBuffer commands) { record(executor, commands, frame_slot); });
    return pixels();
}

}  // namespace splice::test
