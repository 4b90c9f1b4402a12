// Shader modules, pipeline layouts, graphics and compute pipelines.
#pragma once

#include "engine/vulkan/descriptor.h"
#include "engine/vulkan/device.h"
#include "engine/vulkan/handle.h"

#include <vulkan/vulkan_core.h>

#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <vector>

namespace splice::gpu {

class ShaderModule {
  public:
    ShaderModule() = default;
    /// SPIR-V words, as splice_shaders() embeds them. The name shows in validation messages; a
    /// replacement that the device has for it goes before.
    ShaderModule(const Device& device, std::span<const uint32_t> words, const std::string& name);
    VkShaderModule handle() const { return module_.get(); }

  private:
    UniqueShaderModule module_;
};

/// Set layouts in the order of their set numbers, push constants from offset 0 (limits: 128 bytes are guaranteed).
class PipelineLayout {
  public:
    PipelineLayout() = default;
    PipelineLayout(const Device& device, std::span<const VkDescriptorSetLayout> sets, uint32_t push_constant_bytes = 0,
                   VkShaderStageFlags push_constant_stages = VK_SHADER_STAGE_ALL);
    VkPipelineLayout handle() const { return layout_.get(); }

  private:
    UniquePipelineLayout layout_;
};

/// A shader of a pipeline: entry point "main". Specialisation constants by id, 4 bytes each; bools as 0 or 1, floats as
/// std::bit_cast<uint32_t>.
struct ShaderStage {
    const ShaderModule* module = nullptr;
    std::map<uint32_t, uint32_t> constants = {};
};

/// Blending of one colour attachment.
struct Blend {
    bool enable = false;
    VkBlendFactor source_colour = VK_BLEND_FACTOR_ONE, destination_colour = VK_BLEND_FACTOR_ZERO;
    VkBlendFactor source_alpha = VK_BLEND_FACTOR_ONE, destination_alpha = VK_BLEND_FACTOR_ZERO;
    VkBlendOp colour_op = VK_BLEND_OP_ADD, alpha_op = VK_BLEND_OP_ADD;
    VkColorComponentFlags write_mask =
        VK_COLOR_COMPONENT_R_BIT | VK_COLOR_COMPONENT_G_BIT | VK_COLOR_COMPONENT_B_BIT | VK_COLOR_COMPONENT_A_BIT;

    static Blend replace() { return {}; }
    /// destination += source, all four components: the accumulation of splats.
    static Blend additive();
    /// source over destination, premultiplied alpha.
    static Blend over();
    static Blend none();  ///< writes nothing
};

struct GraphicsPipelineOptions {
    std::string name = {};
    ShaderStage vertex = {};
    ShaderStage fragment = {};  ///< no module: depth and stencil only
    VkPipelineLayout layout = VK_NULL_HANDLE;
    VkRenderPass render_pass = VK_NULL_HANDLE;
    uint32_t subpass = 0;

    std::vector<VkVertexInputBindingDescription> vertex_bindings = {};
    std::vector<VkVertexInputAttributeDescription> vertex_attributes = {};
    VkPrimitiveTopology topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST;
    bool primitive_restart = false;

    VkPolygonMode polygon_mode = VK_POLYGON_MODE_FILL;  ///< LINE and POINT need features().fill_mode_non_solid
    VkCullModeFlags cull_mode = VK_CULL_MODE_NONE;
    /// As seen in window coordinates that grow downwards.
    VkFrontFace front_face = VK_FRONT_FACE_COUNTER_CLOCKWISE;
    float depth_bias_constant = 0, depth_bias_slope = 0;  ///< both 0: off
    bool depth_clamp = false;
    VkSampleCountFlagBits samples = VK_SAMPLE_COUNT_1_BIT;

    bool depth_test = false, depth_write = false;
    /// The engine's depth is reversed: 1 at the near plane, 0 at infinity.
    VkCompareOp depth_compare = VK_COMPARE_OP_GREATER;
    bool stencil_test = false;
    VkStencilOpState stencil_front{}, stencil_back{};

    /// One a colour attachment of the subpass, in order of location.
    std::vector<Blend> blends = {};
    /// Beyond viewport and scissor, which are always dynamic.
    std::vector<VkDynamicState> dynamic_states = {};
};

class GraphicsPipeline {
  public:
    GraphicsPipeline() = default;
    /// Throws DeviceError.
    GraphicsPipeline(const Device& device, const GraphicsPipelineOptions& options);
    VkPipeline handle() const { return pipeline_.get(); }
    explicit operator bool() const { return static_cast<bool>(pipeline_); }

  private:
    UniquePipeline pipeline_;
};

class ComputePipeline {
  public:
    ComputePipeline() = default;
    ComputePipeline(const Device& device, const ShaderStage& stage, VkPipelineLayout layout, const std::string& name);
    VkPipeline handle() const { return pipeline_.get(); }
    explicit operator bool() const { return static_cast<bool>(pipeline_); }

  private:
    UniquePipeline pipeline_;
};

}  // namespace splice::gpu
