// Descriptor set layouts, a pool that grows, and writes.
#pragma once

#include "engine/vulkan/device.h"
#include "engine/vulkan/handle.h"

#include <vulkan/vulkan_core.h>

#include <cstdint>
#include <deque>
#include <initializer_list>
#include <span>
#include <vector>

namespace splice::gpu {

struct DescriptorBinding {
    uint32_t binding = 0;
    VkDescriptorType type = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
    VkShaderStageFlags stages = 0;
    uint32_t count = 1;
};

class DescriptorSetLayout {
  public:
    DescriptorSetLayout() = default;
    DescriptorSetLayout(const Device& device, std::span<const DescriptorBinding> bindings);
    DescriptorSetLayout(const Device& device, std::initializer_list<DescriptorBinding> bindings)
        : DescriptorSetLayout(device, std::span(bindings.begin(), bindings.size())) {}
    VkDescriptorSetLayout handle() const { return layout_.get(); }
    const std::vector<DescriptorBinding>& bindings() const { return bindings_; }

  private:
    UniqueDescriptorSetLayout layout_;
    std::vector<DescriptorBinding> bindings_;
};

/// Sets live as long as the pool or until reset(); the pool adds VkDescriptorPools as it fills up.
class DescriptorPool {
  public:
    explicit DescriptorPool(const Device& device) : device_(&device) {}
    VkDescriptorSet allocate(const DescriptorSetLayout& layout);
    /// Frees every set. No submitted work may still use one.
    void reset();

  private:
    const Device* device_;
    std::vector<UniqueDescriptorPool> pools_;
    uint32_t free_sets_ = 0;
};

/// Collects writes to one set:
///   DescriptorWriter(set).storage_buffer(0, surfels).input_attachment(1, view, layout).write(device);
class DescriptorWriter {
  public:
    explicit DescriptorWriter(VkDescriptorSet set) : set_(set) {}
    DescriptorWriter& uniform_buffer(uint32_t binding, VkBuffer buffer, uint64_t offset = 0,
                                     uint64_t size = VK_WHOLE_SIZE);
    DescriptorWriter& storage_buffer(uint32_t binding, VkBuffer buffer, uint64_t offset = 0,
                                     uint64_t size = VK_WHOLE_SIZE);
    DescriptorWriter& input_attachment(uint32_t binding, VkImageView view, VkImageLayout layout);
    DescriptorWriter& storage_image(uint32_t binding, VkImageView view);  ///< layout GENERAL
    DescriptorWriter& sampled_image(uint32_t binding, VkImageView view, VkSampler sampler,
                                    VkImageLayout layout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL,
                                    uint32_t array_element = 0);
    DescriptorWriter& sampled_texels(uint32_t binding, VkBufferView view);
    DescriptorWriter& storage_texels(uint32_t binding, VkBufferView view);
    /// No submitted work may use the set while it is written.
    void write(const Device& device);

  private:
    DescriptorWriter& add_image(uint32_t binding, VkDescriptorType type, const VkDescriptorImageInfo& info,
                                uint32_t array_element);
    DescriptorWriter& add_texels(uint32_t binding, VkDescriptorType type, VkBufferView view);
    VkWriteDescriptorSet& add(uint32_t binding, VkDescriptorType type);
    DescriptorWriter& add_buffer(uint32_t binding, VkDescriptorType type, const VkDescriptorBufferInfo& info);

    VkDescriptorSet set_;
    std::deque<VkDescriptorImageInfo> images_;  // deques: the writes point into them
    std::deque<VkDescriptorBufferInfo> buffers_;
    std::deque<VkBufferView> texels_;
    std::vector<VkWriteDescriptorSet> writes_;
};

}  // namespace splice::gpu
