#include "engine/vulkan/pipeline.h"

#include "engine/vulkan/specialization.h"

namespace splice::gpu {

ShaderModule::ShaderModule(const Device& device, std::span<const uint32_t> words, const std::string& name) {
    if (const std::vector<uint32_t>* replacement = device.replacement_of(name)) words = *replacement;
    VkShaderModuleCreateInfo create{};
    create.sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO;
    create.codeSize = words.size_bytes();
    create.pCode = words.data();
    VkShaderModule handle = VK_NULL_HANDLE;
    check(vkCreateShaderModule(device.handle(), &create, nullptr, &handle), "creating the shader " + name);
    module_ = UniqueShaderModule(device.handle(), handle);
    device.set_name(VK_OBJECT_TYPE_SHADER_MODULE, handle, name);
}

PipelineLayout::PipelineLayout(const Device& device, std::span<const VkDescriptorSetLayout> sets,
                               uint32_t push_constant_bytes, VkShaderStageFlags push_constant_stages) {
    const VkPushConstantRange range{push_constant_stages, 0, push_constant_bytes};
    VkPipelineLayoutCreateInfo create{};
    create.sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO;
    create.setLayoutCount = static_cast<uint32_t>(sets.size());
    create.pSetLayouts = sets.data();
    create.pushConstantRangeCount = push_constant_bytes > 0 ? 1 : 0;
    create.pPushConstantRanges = &range;
    VkPipelineLayout handle = VK_NULL_HANDLE;
    check(vkCreatePipelineLayout(device.handle(), &create, nullptr, &handle), "creating a pipeline layout");
    layout_ = UniquePipelineLayout(device.handle(), handle);
}

ComputePipeline::ComputePipeline(const Device& device, const ShaderStage& stage, VkPipelineLayout layout,
                                 const std::string& name) {
    const Specialization constants(stage);
    VkComputePipelineCreateInfo create{};
    create.sType = VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO;
    create.stage = constants.stage_info(VK_SHADER_STAGE_COMPUTE_BIT);
    create.layout = layout;
    VkPipeline handle = VK_NULL_HANDLE;
    check(vkCreateComputePipelines(device.handle(), device.pipeline_cache(), 1, &create, nullptr, &handle),
          "creating the pipeline " + name);
    pipeline_ = UniquePipeline(device.handle(), handle);
    device.set_name(VK_OBJECT_TYPE_PIPELINE, handle, name);
}

}  // namespace splice::gpu
