// A model's sections on a device: buffers as they lie in the file, one texture a material, and the patch table for the
// culling that the CPU does.
#pragma once

#include "engine/scene/camera.h"
#include "engine/scene/lod_cut.h"
#include "engine/scene/surfel_store.h"
#include "engine/vulkan/buffer.h"
#include "engine/vulkan/descriptor.h"
#include "engine/vulkan/device.h"
#include "engine/vulkan/image.h"
#include "preprocess/model_format/model.h"

#include <vector>

namespace splice {

/// Set 1 of the triangle pass, one a material: binding 0 the diffuse texture, white where there is no image.
gpu::DescriptorSetLayout material_set_layout(const gpu::Device& device);

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
    const SurfelStore& surfels() const { return surfels_; }
    /// Surfels from `first` on, as many as `copies` holds, unpacked; of models with a point tree.
    void copy_surfels(std::uint64_t first, std::span<format::Surfel> copies) const;
    /// Empty where the model has no point tree.
    const PointHierarchy& hierarchy() const { return hierarchy_; }
    /// A record (ellipse_record.h) for each node of the hierarchy.
    std::span<const format::Surfel> ellipses() const { return ellipses_; }
    VkDescriptorSet material_set(std::uint32_t material) const { return material_sets_[material]; }
    /// Source units.
    Box bounds() const;

  private:
    void make_ellipses(const ModelView& model);
    void create_materials(gpu::Device& device, const ModelView& model);

    format::ModelInfo info_{};
    std::vector<format::Patch> patches_;
    std::vector<format::Lod> lods_;
    std::vector<format::OctreeNode> octree_;
    PointHierarchy hierarchy_;
    std::vector<format::Surfel> ellipses_;
    gpu::Buffer vertices_, indices_;
    SurfelStore surfels_;
    std::vector<std::byte> record_copy_;  // where the host cannot read the device's
    std::vector<gpu::Image> images_;      // the last is a white texel
    gpu::UniqueSampler sampler_;
    gpu::DescriptorSetLayout set_layout_;
    gpu::DescriptorPool pool_;
    std::vector<VkDescriptorSet> material_sets_;
};

}  // namespace splice
