// A model's sections on a device: buffers as they lie in the file, one texture a material, and the patch table for the
// culling that the CPU does.
#pragma once

#include "engine/scene/camera.h"
#include "engine/vulkan/buffer.h"
#include "engine/vulkan/descriptor.h"
#include "engine/vulkan/device.h"
#include "engine/vulkan/image.h"
#include "preprocess/model_format/model.h"

#include <vector>

namespace splice {

/// Set 1 of the triangle pass, one a material: binding 0 the diffuse texture, white where there is no image.
gpu::DescriptorSetLayout material_set_layout(const gpu::Device& device);

/// Set 1 of compute passes over surfels: binding 0 the records of a chunk as texels,
/// R32G32B32A32_UINT, two each.
gpu::DescriptorSetLayout surfel_set_layout(const gpu::Device& device);

/// Surfels that one binding holds.
struct SurfelChunk {
    VkDescriptorSet set = VK_NULL_HANDLE;
    std::uint64_t first = 0, count = 0;
};

class GpuModel {
  public:
    /// The view may go away afterwards, the device must outlive the model. Throws DeviceError.
    GpuModel(gpu::Device& device, const ModelView& model);

    const format::ModelInfo& info() const { return info_; }
    bool two_sided() const { return (info_.flags & format::kTwoSided) != 0; }
    const std::vector<format::Patch>& patches() const { return patches_; }
    const std::vector<format::Lod>& lods() const { return lods_; }
    const std::vector<format::OctreeNode>& octree() const { return octree_; }
    const gpu::Buffer& vertices() const { return vertices_; }
    const gpu::Buffer& indices() const { return indices_; }
    const gpu::Buffer& surfels() const { return surfels_; }
    VkDescriptorSet material_set(std::uint32_t material) const { return material_sets_[material]; }
    /// All surfels, in order, in as many pieces as the device's texel buffers need.
    const std::vector<SurfelChunk>& surfel_chunks() const { return surfel_chunks_; }
    /// Source units.
    Box bounds() const;

  private:
    void create_surfel_chunks(gpu::Device& device, std::uint64_t surfels);
    void create_materials(gpu::Device& device, const ModelView& model);

    format::ModelInfo info_{};
    std::vector<format::Patch> patches_;
    std::vector<format::Lod> lods_;
    std::vector<format::OctreeNode> octree_;
    gpu::Buffer vertices_, indices_, surfels_;
    std::vector<gpu::Image> images_;  // the last is a white texel
    gpu::UniqueSampler sampler_;
    gpu::DescriptorSetLayout set_layout_, surfel_layout_;
    gpu::DescriptorPool pool_;
    std::vector<VkDescriptorSet> material_sets_;
    std::vector<gpu::UniqueBufferView> surfel_views_;
    std::vector<SurfelChunk> surfel_chunks_;
};

}  // namespace splice
