#include "engine/vulkan/descriptor.h"

#include <array>

namespace splice::gpu {
namespace {

constexpr uint32_t kSetsPerPool = 64;

// What a full pool of kSetsPerPool sets may hold of each type; a set that needs more gets a pool made to its measure.
constexpr std::array kTypes{VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER,
                            VK_DESCRIPTOR_TYPE_STORAGE_BUFFER,
                            VK_DESCRIPTOR_TYPE_STORAGE_IMAGE,
                            VK_DESCRIPTOR_TYPE_INPUT_ATTACHMENT,
                            VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER,
                            VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE,
                            VK_DESCRIPTOR_TYPE_SAMPLER,
                            VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER,
                            VK_DESCRIPTOR_TYPE_STORAGE_TEXEL_BUFFER};

}  // namespace

DescriptorSetLayout::DescriptorSetLayout(const Device& device, std::span<const DescriptorBinding> bindings)
    : bindings_(bindings.begin(), bindings.end()) {
    std::vector<VkDescriptorSetLayoutBinding> infos;
    for (const DescriptorBinding& binding : bindings) {
        infos.push_back({binding.binding, binding.type, binding.count, binding.stages, nullptr});
    }
    VkDescriptorSetLayoutCreateInfo create{};
    create.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO;
    create.bindingCount = static_cast<uint32_t>(infos.size());
    create.pBindings = infos.data();
    VkDescriptorSetLayout handle = VK_NULL_HANDLE;
    check(vkCreateDescriptorSetLayout(device.handle(), &create, nullptr, &handle), "creating a descriptor set layout");
    layout_ = UniqueDescriptorSetLayout(device.handle(), handle);
}

VkDescriptorSet DescriptorPool::allocate(const DescriptorSetLayout& layout) {
    const VkDescriptorSetLayout layout_handle = layout.handle();
    VkDescriptorSetAllocateInfo allocate{};
    allocate.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO;
    allocate.descriptorSetCount = 1;
    allocate.pSetLayouts = &layout_handle;
    VkDescriptorSet set = VK_NULL_HANDLE;
    if (free_sets_ > 0) {
        allocate.descriptorPool = pools_.back().get();
        --free_sets_;
        const VkResult result = vkAllocateDescriptorSets(device_->handle(), &allocate, &set);
        if (result == VK_SUCCESS) return set;
        if (result != VK_ERROR_OUT_OF_POOL_MEMORY && result != VK_ERROR_FRAGMENTED_POOL) {
            check(result, "allocating a descriptor set");
        }
    }
    std::vector<VkDescriptorPoolSize> sizes;
    sizes.reserve(kTypes.size() + layout.bindings().size());
    for (const VkDescriptorType type : kTypes)
        sizes.push_back({type, 2 * kSetsPerPool});
    for (const DescriptorBinding& binding : layout.bindings())
        sizes.push_back({binding.type, binding.count});
    VkDescriptorPoolCreateInfo create{};
    create.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO;
    create.maxSets = kSetsPerPool;
    create.poolSizeCount = static_cast<uint32_t>(sizes.size());
    create.pPoolSizes = sizes.data();
    VkDescriptorPool pool = VK_NULL_HANDLE;
    check(vkCreateDescriptorPool(device_->handle(), &create, nullptr, &pool), "creating a descriptor pool");
    pools_.emplace_back(device_->handle(), pool);
    free_sets_ = kSetsPerPool - 1;
    allocate.descriptorPool = pool;
    check(vkAllocateDescriptorSets(device_->handle(), &allocate, &set), "allocating a descriptor set");
    return set;
}

void DescriptorPool::reset() {
    pools_.clear();
    free_sets_ = 0;
}

VkWriteDescriptorSet& DescriptorWriter::add(uint32_t binding, VkDescriptorType type) {
    VkWriteDescriptorSet& write = writes_.emplace_back();
    write.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET;
    write.dstSet = set_;
    write.dstBinding = binding;
    write.descriptorCount = 1;
    write.descriptorType = type;
    return write;
}

DescriptorWriter& DescriptorWriter::add_buffer(uint32_t binding, VkDescriptorType type,
                                               const VkDescriptorBufferInfo& info) {
    add(binding, type).pBufferInfo = &buffers_.emplace_back(info);
    return *this;
}

DescriptorWriter& DescriptorWriter::add_image(uint32_t binding, VkDescriptorType type,
                                              const VkDescriptorImageInfo& info, uint32_t array_element) {
    VkWriteDescriptorSet& write = add(binding, type);
    write.dstArrayElement = array_element;
    write.pImageInfo = &images_.emplace_back(info);
    return *this;
}

DescriptorWriter& DescriptorWriter::add_texels(uint32_t binding, VkDescriptorType type, VkBufferView view) {
    add(binding, type).pTexelBufferView = &texels_.emplace_back(view);
    return *this;
}

DescriptorWriter& DescriptorWriter::sampled_texels(uint32_t binding, VkBufferView view) {
    return add_texels(binding, VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER, view);
}

DescriptorWriter& DescriptorWriter::storage_texels(uint32_t binding, VkBufferView view) {
    return add_texels(binding, VK_DESCRIPTOR_TYPE_STORAGE_TEXEL_BUFFER, view);
}

DescriptorWriter& DescriptorWriter::uniform_buffer(uint32_t binding, VkBuffer buffer, uint64_t offset, uint64_t size) {
    return add_buffer(binding, VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, {buffer, offset, size});
}

DescriptorWriter& DescriptorWriter::storage_buffer(uint32_t binding, VkBuffer buffer, uint64_t offset, uint64_t size) {
    return add_buffer(binding, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, {buffer, offset, size});
}

DescriptorWriter& DescriptorWriter::input_attachment(uint32_t binding, VkImageView view, VkImageLayout layout) {
    return add_image(binding, VK_DESCRIPTOR_TYPE_INPUT_ATTACHMENT, {VK_NULL_HANDLE, view, layout}, 0);
}

DescriptorWriter& DescriptorWriter::storage_image(uint32_t binding, VkImageView view) {
    return add_image(binding, VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, {VK_NULL_HANDLE, view, VK_IMAGE_LAYOUT_GENERAL}, 0);
}

DescriptorWriter& DescriptorWriter::sampled_image(uint32_t binding, VkImageView view, VkSampler sampler,
                                                  VkImageLayout layout, uint32_t array_element) {
    return add_image(binding, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, {sampler, view, layout}, array_element);
}

void DescriptorWriter::write(const Device& device) {
    vkUpdateDescriptorSets(device.handle(), static_cast<uint32_t>(writes_.size()), writes_.data(), 0, nullptr);
}

}  // namespace splice::gpu
