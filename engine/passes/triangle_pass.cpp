#include "engine/passes/triangle_pass.h"

#include "engine/scene/gpu_model.h"
#include "preprocess/model_format/error.h"
#include "shaders/triangle_frag.h"
#include "shaders/triangle_vert.h"

#include <array>

namespace splice {

namespace {

// Wires lie on the faces that they outline; reversed depth makes a positive bias pull them to the eye.
constexpr float kWireBias = 64, kWireSlopeBias = 1;

}  // namespace

TrianglePass::TrianglePass(gpu::Device& device, const FrameData& data)
    : device_(device),
      data_(data),
      material_layout_(material_set_layout(device)),
      layout_(device, std::array{data.layout().handle(), material_layout_.handle()}, sizeof(InstanceConstants),
              VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT),
      vertex_(device, triangle_vert, "triangle.vert"),
      fragment_(device, triangle_frag, "triangle.frag") {}

void TrianglePass::add(graph::Graph& graph, FrameTargets& targets, const FrameSettings& settings, const DrawList& draws,
                       const std::optional<VkClearValue>& picture) {
    const bool wires = settings.view == View::kWireframe;
    if (wires && !device_.features().fill_mode_non_solid)
        throw UsageError("--view wireframe: the device " + device_.info().name + " cannot draw wires");
    graph::Pass pass = graph.add_pass("triangle", graph::PassKind::graphics);
    graph::ImageHandle& colour = picture ? targets.picture : targets.triangle_colour;
    colour = pass.colour_attachment(colour, graph::Contents::clear(picture.value_or(graph::clear_colour(0, 0, 0, 0))));
    targets.depth =
        pass.depth_stencil_attachment(targets.depth, graph::Contents::clear(graph::clear_depth_stencil(0, 0)));
    pass.record([this, &settings, &draws, wires, to_picture = picture.has_value()](const graph::PassContext& context) {
        draw(context, settings, draws, to_picture, false);
        if (wires) draw(context, settings, draws, to_picture, true);
    });
}

void TrianglePass::draw(const graph::PassContext& context, const FrameSettings& settings, const DrawList& draws,
                        bool to_picture, bool wires) {
    const VkCommandBuffer commands = context.commands;
    for (const InstanceDraws& instance : draws.instances) {
        if (instance.triangles.empty()) continue;
        const Variant variant{.wires = wires, .two_sided = instance.two_sided, .to_picture = to_picture};
        graph::PassPipelines& pipelines = pipelines_[{frame_variant(settings), variant}];
        vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS,
                          pipelines.get(device_, context, [&] { return pipeline_options(settings, variant); }));
        const VkDescriptorSet frame_set = data_.set();
        vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, layout_.handle(), 0, 1, &frame_set, 0,
                                nullptr);
        const InstanceConstants constants = instance_constants(instance, settings.epsilon_scale);
        vkCmdPushConstants(commands, layout_.handle(), VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT, 0,
                           sizeof constants, &constants);
        const VkBuffer vertices = instance.model->vertices().handle();
        const VkDeviceSize zero = 0;
        vkCmdBindVertexBuffers(commands, 0, 1, &vertices, &zero);
        VkDescriptorSet bound_material = VK_NULL_HANDLE;
        for (const DrawRange& range : instance.triangles) {
            const VkDescriptorSet material = instance.model->material_set(range.material);
            if (material != bound_material)
                vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, layout_.handle(), 1, 1, &material, 0,
                                        nullptr);
            bound_material = material;
            // The offset takes what would not fit the 32 bits of a draw's first index.
            vkCmdBindIndexBuffer(commands, instance.indices->handle(), range.first * sizeof(std::uint32_t),
                                 VK_INDEX_TYPE_UINT32);
            vkCmdDrawIndexed(commands, range.count, 1, 0, 0, range.patch);
        }
    }
}

gpu::GraphicsPipelineOptions TrianglePass::pipeline_options(const FrameSettings& settings,
                                                            const Variant& variant) const {
    gpu::GraphicsPipelineOptions options;
    options.name = variant.wires ? "triangle wires" : "triangle";
    options.vertex = {&vertex_, frame_constants(settings)};
    options.fragment = {&fragment_, frame_constants(settings)};
    options.fragment.constants[0] = variant.wires ? 1u : 0u;
    options.fragment.constants[3] = variant.to_picture ? 1u : 0u;
    options.layout = layout_.handle();
    options.vertex_bindings = {{0, sizeof(format::Vertex), VK_VERTEX_INPUT_RATE_VERTEX}};
    options.vertex_attributes = {
        {0, 0, VK_FORMAT_R32G32B32_SFLOAT, offsetof(format::Vertex, position)},
        {1, 0, VK_FORMAT_R16G16_SNORM, offsetof(format::Vertex, normal)},
        {2, 0, VK_FORMAT_R8G8B8A8_UNORM, offsetof(format::Vertex, colour)},
        {3, 0, VK_FORMAT_R32G32_SFLOAT, offsetof(format::Vertex, uv)},
    };
    options.cull_mode = variant.two_sided ? VK_CULL_MODE_NONE : VK_CULL_MODE_BACK_BIT;
    options.front_face = VK_FRONT_FACE_COUNTER_CLOCKWISE;
    options.depth_test = true;
    options.depth_write = true;
    options.depth_compare = VK_COMPARE_OP_GREATER;
    options.blends = {gpu::Blend::replace()};
    if (variant.wires) {
        options.polygon_mode = VK_POLYGON_MODE_LINE;
        options.depth_bias_constant = kWireBias;
        options.depth_bias_slope = kWireSlopeBias;
        options.depth_write = false;
    }
    return options;
}

}  // namespace splice
