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
    const VkVertexInputRate rate = quads ? VK_VERTEX_INPUT_RATE_INSTANCE : VK_VERTEX_INPUT_RATE_VERTEX;
    // Both halves of a record; of a packed one, twice the same. Strides come with the buffers.
    options.vertex_bindings = {{0, 0, rate}, {1, 0, rate}};
    options.vertex_attributes = {{0, 0, VK_FORMAT_R32G32B32A32_UINT, 0}, {1, 1, VK_FORMAT_R32G32B32A32_UINT, 0}};
    options.dynamic_states.push_back(VK_DYNAMIC_STATE_VERTEX_INPUT_BINDING_STRIDE);
    options.topology = quads ? VK_PRIMITIVE_TOPOLOGY_TRIANGLE_STRIP : VK_PRIMITIVE_TOPOLOGY_POINT_LIST;
    options.vertex.constants[0] = quads ? 1u : 0u;
}

void bind_surfels(VkCommandBuffer commands, VkBuffer records, std::uint64_t first, std::uint64_t stride) {
    const std::array buffers{records, records};
    const std::array<VkDeviceSize, 2> offsets{first * stride, first * stride + stride - sizeof(format::PackedSurfel)},
        strides{stride, stride};
    vkCmdBindVertexBuffers2(commands, 0, static_cast<std::uint32_t>(buffers.size()), buffers.data(), offsets.data(),
                            nullptr, strides.data());
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
    InstanceConstants constants = instance_constants(instance, settings.epsilon_scale);
    for (const DrawRange& range : ranges) {
        constants.first_surfel = static_cast<std::uint32_t>(range.first);
        vkCmdPushConstants(commands, layout_.handle(), kConstantStages, 0, sizeof constants, &constants);
        // Whole ranges by offset, so that vertex numbers start at 0 in both kinds and 32 bits suffice.
        bind_surfels(commands, instance.surfels->buffer().handle(), range.first, instance.surfels->stride());
        if (quads) {
            vkCmdDraw(commands, kQuadVertices, range.count, 0, 0);
        } else {
            vkCmdDraw(commands, range.count, 1, 0, 0);
        }
    }
}

}  // namespace splice
