#include "engine/vulkan/pipeline.h"
#include "engine/vulkan/specialization.h"

#include <optional>

namespace splice::gpu {

Blend Blend::additive() {
    Blend blend;
    blend.enable = true;
    blend.destination_colour = blend.destination_alpha = VK_BLEND_FACTOR_ONE;
    return blend;
}

Blend Blend::over() {
    Blend blend;
    blend.enable = true;
    blend.destination_colour = blend.destination_alpha = VK_BLEND_FACTOR_ONE_MINUS_SRC_ALPHA;
    return blend;
}

Blend Blend::none() {
    Blend blend;
    blend.write_mask = 0;
    return blend;
}

GraphicsPipeline::GraphicsPipeline(const Device& device, const GraphicsPipelineOptions& options) {
    const Specialization vertex(options.vertex);
    std::optional<Specialization> fragment;
    std::vector<VkPipelineShaderStageCreateInfo> stages{vertex.stage_info(VK_SHADER_STAGE_VERTEX_BIT)};
    if (options.fragment.module) {
        fragment.emplace(options.fragment);
        stages.push_back(fragment->stage_info(VK_SHADER_STAGE_FRAGMENT_BIT));
    }

    VkPipelineVertexInputStateCreateInfo input{};
    input.sType = VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO;
    input.vertexBindingDescriptionCount = static_cast<uint32_t>(options.vertex_bindings.size());
    input.pVertexBindingDescriptions = options.vertex_bindings.data();
    input.vertexAttributeDescriptionCount = static_cast<uint32_t>(options.vertex_attributes.size());
    input.pVertexAttributeDescriptions = options.vertex_attributes.data();

    VkPipelineInputAssemblyStateCreateInfo assembly{};
    assembly.sType = VK_STRUCTURE_TYPE_PIPELINE_INPUT_ASSEMBLY_STATE_CREATE_INFO;
    assembly.topology = options.topology;
    assembly.primitiveRestartEnable = options.primitive_restart ? VK_TRUE : VK_FALSE;

    VkPipelineViewportStateCreateInfo viewport{};
    viewport.sType = VK_STRUCTURE_TYPE_PIPELINE_VIEWPORT_STATE_CREATE_INFO;
    viewport.viewportCount = viewport.scissorCount = 1;

    VkPipelineRasterizationStateCreateInfo raster{};
    raster.sType = VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_STATE_CREATE_INFO;
    raster.depthClampEnable = options.depth_clamp ? VK_TRUE : VK_FALSE;
    raster.polygonMode = options.polygon_mode;
    raster.cullMode = options.cull_mode;
    raster.frontFace = options.front_face;
    raster.depthBiasEnable = options.depth_bias_constant != 0 || options.depth_bias_slope != 0 ? VK_TRUE : VK_FALSE;
    raster.depthBiasConstantFactor = options.depth_bias_constant;
    raster.depthBiasSlopeFactor = options.depth_bias_slope;
    raster.lineWidth = 1;

    VkPipelineMultisampleStateCreateInfo multisample{};
    multisample.sType = VK_STRUCTURE_TYPE_PIPELINE_MULTISAMPLE_STATE_CREATE_INFO;
    multisample.rasterizationSamples = options.samples;

    VkPipelineDepthStencilStateCreateInfo depth{};
    depth.sType = VK_STRUCTURE_TYPE_PIPELINE_DEPTH_STENCIL_STATE_CREATE_INFO;
    depth.depthTestEnable = options.depth_test ? VK_TRUE : VK_FALSE;
    depth.depthWriteEnable = options.depth_write ? VK_TRUE : VK_FALSE;
    depth.depthCompareOp = options.depth_compare;
    depth.stencilTestEnable = options.stencil_test ? VK_TRUE : VK_FALSE;
    depth.front = options.stencil_front;
    depth.back = options.stencil_back;
    depth.maxDepthBounds = 1;

    std::vector<VkPipelineColorBlendAttachmentState> attachments;
    for (const Blend& blend : options.blends) {
        attachments.push_back({blend.enable ? VK_TRUE : VK_FALSE, blend.source_colour, blend.destination_colour,
                               blend.colour_op, blend.source_alpha, blend.destination_alpha, blend.alpha_op,
                               blend.write_mask});
    }
    VkPipelineColorBlendStateCreateInfo colour{};
    colour.sType = VK_STRUCTURE_TYPE_PIPELINE_COLOR_BLEND_STATE_CREATE_INFO;
    colour.attachmentCount = static_cast<uint32_t>(attachments.size());
    colour.pAttachments = attachments.data();

    std::vector<VkDynamicState> states{VK_DYNAMIC_STATE_VIEWPORT, VK_DYNAMIC_STATE_SCISSOR};
    states.insert(states.end(), options.dynamic_states.begin(), options.dynamic_states.end());
    VkPipelineDynamicStateCreateInfo dynamic{};
    dynamic.sType = VK_STRUCTURE_TYPE_PIPELINE_DYNAMIC_STATE_CREATE_INFO;
    dynamic.dynamicStateCount = static_cast<uint32_t>(states.size());
    dynamic.pDynamicStates = states.data();

    VkGraphicsPipelineCreateInfo create{};
    create.sType = VK_STRUCTURE_TYPE_GRAPHICS_PIPELINE_CREATE_INFO;
    create.stageCount = static_cast<uint32_t>(stages.size());
    create.pStages = stages.data();
    create.pVertexInputState = &input;
    create.pInputAssemblyState = &assembly;
    create.pViewportState = &viewport;
    create.pRasterizationState = &raster;
    create.pMultisampleState = &multisample;
    create.pDepthStencilState = &depth;
    create.pColorBlendState = &colour;
    create.pDynamicState = &dynamic;
    create.layout = options.layout;
    create.renderPass = options.render_pass;
    create.subpass = options.subpass;
    VkPipeline handle = VK_NULL_HANDLE;
    check(vkCreateGraphicsPipelines(device.handle(), device.pipeline_cache(), 1, &create, nullptr, &handle),
          "creating the pipeline " + options.name);
    pipeline_ = UniquePipeline(device.handle(), handle);
    device.set_name(VK_OBJECT_TYPE_PIPELINE, handle, options.name);
}

}  // namespace splice::gpu
