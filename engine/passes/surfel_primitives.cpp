#include "engine/passes/surfel_primitives.h"

#include "engine/scene/surfel_store.h"
#include "preprocess/model_format/model_format.h"

#include <array>

namespace splice {

namespace {

constexpr VkShaderStageFlags kConstantStages = VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT;
constexpr std::uint32_t kQuadVertices = 4;

}  // namespace

void add_surfel_input(gpu::GraphicsPipelineOptions& options, bool quads) {
    options.vertex_bindings = {
        {0, sizeof(format::Surfel), quads ? VK_VERTEX_INPUT_RATE_INSTANCE : VK_VERTEX_INPUT_RATE_VERTEX}};
    options.vertex_attributes = {
        {0, 0, VK_FORMAT_R32G32B32_SFLOAT, offsetof(format::Surfel, position)},
        {1, 0, VK_FORMAT_R16_SFLOAT, offsetof(format::Surfel, radius)},
        {7, 0, VK_FORMAT_R16_UINT, offsetof(format::Surfel, extent)},
        {2, 0, VK_FORMAT_R16G16_SNORM, offsetof(format::Surfel, normal)},
        {3, 0, VK_FORMAT_R8G8B8A8_UNORM, offsetof(format::Surfel, colour)},
        {4, 0, VK_FORMAT_R8_SNORM, offsetof(format::Surfel, shading_bend)},
        {6, 0, VK_FORMAT_R8G8B8A8_SNORM, offsetof(format::Surfel, shading_bend) + 1},
        {5, 0, VK_FORMAT_R32_UINT, offsetof(format::Surfel, patch)},
    };
    options.topology = quads ? VK_PRIMITIVE_TOPOLOGY_TRIANGLE_STRIP : VK_PRIMITIVE_TOPOLOGY_POINT_LIST;
    options.vertex.constants[0] = quads ? 1u : 0u;
}

SurfelPrimitives::SurfelPrimitives(gpu::Device& device, const FrameData& data)
    : device_(device),
      data_(data),
      layout_(device, std::array{data.layout().handle()}, sizeof(InstanceConstants), kConstantStages) {}

void SurfelPrimitives::draw(const graph::PassContext& context, const FrameSettings& settings, const DrawList& draws,
                            const std::function<gpu::GraphicsPipelineOptions()>& options) {
    for (const InstanceDraws& instance : draws.instances) {
        draw_ranges(context, settings, instance, options, false);
        draw_ranges(context, settings, instance, options, true);
    }
}

void SurfelPrimitives::draw_ranges(const graph::PassContext& context, const FrameSettings& settings,
                                   const InstanceDraws& instance,
                                   const std::function<gpu::GraphicsPipelineOptions()>& options, bool quads) {
    const auto& ranges = quads ? instance.quads : instance.sprites;
    if (ranges.empty()) return;
    const VkCommandBuffer commands = context.commands;
    vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS,
                      pipelines_[{frame_variant(settings), quads}].get(device_, context, [&] {
                          gpu::GraphicsPipelineOptions all = options();
                          all.layout = layout_.handle();
                          all.vertex.constants = all.fragment.constants = frame_constants(settings);
                          add_surfel_input(all, quads);
                          return all;
                      }));
    const VkDescriptorSet frame_set = data_.set();
    vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, layout_.handle(), 0, 1, &frame_set, 0, nullptr);
    const InstanceConstants constants = instance_constants(instance, settings.epsilon_scale);
    vkCmdPushConstants(commands, layout_.handle(), kConstantStages, 0, sizeof constants, &constants);
    const VkBuffer surfels = instance.surfels->buffer().handle();
    for (const DrawRange& range : ranges) {
        // Whole ranges by offset, so that vertex numbers start at 0 in both kinds and 32 bits suffice.
        const VkDeviceSize offset = range.first * sizeof(format::Surfel);
        vkCmdBindVertexBuffers(commands, 0, 1, &surfels, &offset);
        if (quads) {
            vkCmdDraw(commands, kQuadVertices, range.count, 0, 0);
        } else {
            vkCmdDraw(commands, range.count, 1, 0, 0);
        }
    }
}

}  // namespace splice
