#include "engine/passes/box_pass.h"

#include "engine/scene/gpu_model.h"
#include "shaders/box_frag.h"
#include "shaders/box_vert.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstring>
#include <vector>

namespace splice {

namespace {

constexpr std::uint32_t kVertices = 12 * 6;  // of a box: edges of two triangles each

// Edges may lie on surfaces: the least that pulls them before those.
constexpr float kBias = 64;

}  // namespace

BoxPass::BoxPass(gpu::Device& device, const FrameData& data)
    : device_(device),
      data_(data),
      layout_(device, std::array{data.layout().handle()}, sizeof(InstanceConstants),
              VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT),
      vertex_(device, box_vert, "box.vert"),
      fragment_(device, box_frag, "box.frag") {}

void BoxPass::add(graph::Graph& graph, FrameTargets& targets, const FrameSettings& settings, const DrawList& draws) {
    upload(draws);
    graph::Pass pass = graph.add_pass("boxes", graph::PassKind::graphics);
    pass.depth_stencil_read(targets.depth);
    targets.picture = pass.colour_attachment(targets.picture, graph::Contents::keep());
    pass.record([this, &settings, &draws](const graph::PassContext& context) { draw(context, settings, draws); });
}

void BoxPass::upload(const DrawList& draws) {
    std::vector<NodeBox> boxes;
    for (const InstanceDraws& instance : draws.instances)
        boxes.insert(boxes.end(), instance.boxes.begin(), instance.boxes.end());
    const std::size_t bytes = boxes.size() * sizeof(NodeBox);
    if (bytes == 0) return;
    if (!boxes_ || boxes_.size() < bytes)
        // Validation layers take an instance's attributes for a vertex's, and so that many for read.
        boxes_ = gpu::Buffer(device_, {.size = std::max(bytes, kVertices * sizeof(NodeBox)),
                                       .usage = VK_BUFFER_USAGE_VERTEX_BUFFER_BIT,
                                       .memory = gpu::MemoryUse::upload,
                                       .name = "boxes"});
    std::memcpy(boxes_.mapped().data(), boxes.data(), bytes);
}

void BoxPass::draw(const graph::PassContext& context, const FrameSettings& settings, const DrawList& draws) {
    const VkCommandBuffer commands = context.commands;
    std::uint32_t first = 0;
    for (const InstanceDraws& instance : draws.instances) {
        if (instance.boxes.empty()) continue;
        vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS,
                          pipelines_[{frame_variant(settings), settings.antialias > 1}].get(
                              device_, context, [&] { return pipeline_options(settings); }));
        const VkDescriptorSet frame_set = data_.set();
        vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, layout_.handle(), 0, 1, &frame_set, 0,
                                nullptr);
        const InstanceConstants constants = instance_constants(instance, settings.epsilon_scale);
        vkCmdPushConstants(commands, layout_.handle(), VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT, 0,
                           sizeof constants, &constants);
        const VkBuffer boxes = boxes_.handle();
        const VkDeviceSize zero = 0;
        vkCmdBindVertexBuffers(commands, 0, 1, &boxes, &zero);
        const auto count = static_cast<std::uint32_t>(instance.boxes.size());
        vkCmdDraw(commands, kVertices, count, 0, first);
        first += count;
    }
}

gpu::GraphicsPipelineOptions BoxPass::pipeline_options(const FrameSettings& settings) const {
    gpu::GraphicsPipelineOptions options;
    options.name = "boxes";
    options.vertex = {&vertex_, frame_constants(settings)};
    options.fragment = {&fragment_, frame_constants(settings)};
    options.fragment.constants[4] = settings.antialias > 1 ? 1u : 0u;
    options.layout = layout_.handle();
    options.vertex_bindings = {{0, sizeof(NodeBox), VK_VERTEX_INPUT_RATE_INSTANCE}};
    options.vertex_attributes = {{0, 0, VK_FORMAT_R32G32B32_SFLOAT, offsetof(NodeBox, low)},
                                 {1, 0, VK_FORMAT_R32G32B32_SFLOAT, offsetof(NodeBox, high)},
                                 {2, 0, VK_FORMAT_R32_UINT, offsetof(NodeBox, level)}};
    options.depth_test = true;
    options.depth_compare = VK_COMPARE_OP_GREATER;
    options.depth_bias_constant = kBias;
    options.blends = {gpu::Blend::replace()};
    return options;
}

}  // namespace splice
