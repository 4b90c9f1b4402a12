// The specialisation constants of one shader stage in the form that Vulkan takes.
#pragma once

#include "engine/vulkan/pipeline.h"

#include <vulkan/vulkan_core.h>

#include <cstdint>
#include <vector>

namespace splice::gpu {

/// Owns the arrays that stage_info() points to, so it stays where it is until the pipeline is made.
class Specialization {
  public:
    explicit Specialization(const ShaderStage& stage) : module_(stage.module->handle()) {
        for (const auto& [id, value] : stage.constants) {
            entries_.push_back({id, static_cast<uint32_t>(values_.size() * sizeof(uint32_t)), sizeof(uint32_t)});
            values_.push_back(value);
        }
        info_ = {static_cast<uint32_t>(entries_.size()), entries_.data(), values_.size() * sizeof(uint32_t),
                 values_.data()};
    }
    Specialization(const Specialization&) = delete;
    Specialization& operator=(const Specialization&) = delete;

    VkPipelineShaderStageCreateInfo stage_info(VkShaderStageFlagBits stage) const {
        VkPipelineShaderStageCreateInfo info{};
        info.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO;
        info.stage = stage;
        info.module = module_;
        info.pName = "main";
        info.pSpecializationInfo = &info_;
        return info;
    }

  private:
    VkShaderModule module_;
    std::vector<VkSpecializationMapEntry> entries_;
    std::vector<uint32_t> values_;
    VkSpecializationInfo info_{};
};

}  // namespace splice::gpu
