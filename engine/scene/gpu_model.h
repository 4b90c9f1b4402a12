// A model's sections on a device: buffers as they lie in the file, one texture a material, and the patch table for the
// culling that the CPU does.
#pragma once

#include "engine/scene/camera.h"
#include "engine/scene/lod_cut.h"
#include "engine/scene/merged_surfels.h"
#include "engine/scene/paging.h"
#include "engine/scene/patch_groups.h"
#include "engine/scene/surfel_pager.h"
#include "engine/scene/surfel_store.h"
#include "engine/scene/triangle_bounds.h"
#include "engine/vulkan/buffer.h"
#include "engine/vulkan/descriptor.h"
#include "engine/vulkan/device.h"
#include "engine/vulkan/image.h"
#include "preprocess/model_format/model.h"

#include <memory>
#include <vector>

namespace splice {

/// Set 1 of the triangle pass, one a material: binding 0 the diffuse texture, white where there is no image.
gpu::DescriptorSetLayout material_set_layout(const gpu::Device& device);

/// A leaf of the point tree.
struct TreeLeaf {
    std::uint32_t node;
    std::uint32_t level;  // depth in the tree, counted from 1
};

class GpuModel {
  public:
    /// The view may go away afterwards, the device must outlive the model. Throws DeviceError.
    explicit GpuModel(gpu::Device& device, const ModelView& model) : GpuModel(device, model, {}) {}
    /// Surfels that do not fit into the limit stay in the view's memory and come through pager(), if the model has a
    /// point tree to draw in their place.
    GpuModel(gpu::Device& device, const ModelView& model, const Paging& paging);

    const format::ModelInfo& info() const { return info_; }
    bool two_sided() const { return (info_.flags & format::kTwoSided) != 0; }
    const std::vector<format::Patch>& patches() const { return patches_; }
    const std::vector<format::Lod>& lods() const { return lods_; }
    const std::vector<format::OctreeNode>& octree() const { return octree_; }
    /// One a node of the octree.
    const std::vector<PatchGroupContent>& group_contents() const { return group_contents_; }
    const TriangleBounds& triangle_bounds() const { return triangle_bounds_; }
    const gpu::Buffer& vertices() const { return vertices_; }
    const gpu::Buffer& indices() const { return indices_; }
    /// All surfels, then what stands for them (merged_levels()).
    const SurfelStore& surfels() const { return surfels_; }
    /// Finest first; a range of surfels() for each patch. None of models that are packed or paged: those have a point
    /// tree.
    const std::vector<std::vector<MergedRange>>& merged_levels() const { return merged_levels_; }
    /// Null where all surfels are in surfels(); else those are none, and frames are cuts.
    SurfelPager* pager() const { return pager_.get(); }
    std::uint64_t surfel_count() const { return surfel_count_; }
    /// Bytes a surfel, in surfels() and in the pager.
    std::uint64_t surfel_bytes() const { return surfels_.stride(); }
    /// Of a paged model: the leaves of the hierarchy, in the order of their surfels.
    std::span<const TreeLeaf> leaves() const { return leaves_; }
    /// Records as they lie in the pager, unpacked; `first`: the number of the first of them.
    void unpack_surfels(std::span<const std::byte> records, std::uint64_t first,
                        std::span<format::Surfel> copies) const;
    /// Surfels from `first` on, as many as `copies` holds, unpacked; of models with a point tree.
    /// Of a paged one, those that settle_pages() left in a cut.
    void copy_surfels(std::uint64_t first, std::span<format::Surfel> copies) const;
    /// Empty where the model has no point tree.
    const PointHierarchy& hierarchy() const { return hierarchy_; }
    /// A record (ellipse_record.h) for each node of the hierarchy.
    std::span<const format::Surfel> ellipses() const { return ellipses_; }
    VkDescriptorSet material_set(std::uint32_t material) const { return material_sets_[material]; }
    /// Of the surface that it was baked from, whatever represents it; source units. Pictures are framed by it.
    const Box& bounds() const { return bounds_; }
    /// Of all that is drawn: disks overhang the surface.
    const Box& drawn_bounds() const { return drawn_bounds_; }

  private:
    GpuModel(gpu::Device& device, const ModelView& model, const Paging& paging,
             const std::vector<format::PointNode>& tree, MergedSurfels merged);
    void make_ellipses(const ModelView& model, const std::vector<format::PointNode>& tree);
    void page(const ModelView& model, const Paging& paging);
    void create_materials(gpu::Device& device, const ModelView& model);
    Box to_source(const glm::dvec3& low, const glm::dvec3& high) const;  // from unit-box units

    format::ModelInfo info_{};
    Box bounds_, drawn_bounds_;
    std::vector<format::Patch> patches_;
    std::vector<format::Lod> lods_;
    std::vector<format::OctreeNode> octree_;
    std::vector<PatchGroupContent> group_contents_;
    TriangleBounds triangle_bounds_;
    PointHierarchy hierarchy_;
    std::vector<format::Surfel> ellipses_;
    std::vector<std::vector<MergedRange>> merged_levels_;
    gpu::Buffer vertices_, indices_;
    std::uint64_t surfel_count_;
    bool paged_;
    SurfelStore surfels_;
    std::vector<TreeLeaf> leaves_;
    std::vector<std::byte> record_copy_;          // where the host cannot read the device's
    std::vector<gpu::Image> images_;              // the last is a white texel
    gpu::UniqueSampler sampler_, plain_sampler_;  // of images, of white
    gpu::DescriptorSetLayout set_layout_;
    gpu::DescriptorPool pool_;
    std::vector<VkDescriptorSet> material_sets_;
    std::unique_ptr<SurfelPager> pager_;
};

}  // namespace splice
