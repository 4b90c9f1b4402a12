#include "engine/scene/gpu_model.h"

#include "engine/scene/ellipse_record.h"
#include "engine/vulkan/transfer.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>

namespace splice {

namespace {

constexpr VkFormat kTextureFormat = VK_FORMAT_R8G8B8A8_SRGB;
constexpr float kAnisotropy = 8;

gpu::Image create_texture(gpu::Device& device, const format::Texture& texture, std::span<const std::byte> texels) {
    std::uint32_t width = texture.width, height = texture.height, levels = texture.mip_levels;
    std::uint64_t first_byte = texture.first_byte;
    const auto halve = [](std::uint32_t side) { return std::max(side / 2, 1u); };
    // A level that the device cannot hold is left out; the next one is good enough for it.
    while (levels > 1 && std::max(width, height) > device.limits().maxImageDimension2D) {
        first_byte += std::uint64_t{4} * width * height;
        width = halve(width);
        height = halve(height);
        --levels;
    }
    gpu::Image image(device, {.format = kTextureFormat,
                              .width = width,
                              .height = height,
                              .mip_levels = levels,
                              .usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT,
                              .name = "texture"});
    std::vector<VkBufferImageCopy> regions;
    std::uint64_t offset = 0;
    for (std::uint32_t level = 0; level < levels; ++level) {
        VkBufferImageCopy region{};
        region.bufferOffset = offset;
        region.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, level, 0, 1};
        region.imageExtent = {width, height, 1};
        regions.push_back(region);
        offset += std::uint64_t{4} * width * height;
        width = halve(width);
        height = halve(height);
    }
    gpu::upload(device, image, texels.subspan(first_byte, offset), regions);
    return image;
}

}  // namespace

gpu::DescriptorSetLayout material_set_layout(const gpu::Device& device) {
    return {device, {{0, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, VK_SHADER_STAGE_FRAGMENT_BIT, 1}}};
}

GpuModel::GpuModel(gpu::Device& device, const ModelView& model)
    : info_(*model.info),
      patches_(model.patches.begin(), model.patches.end()),
      lods_(model.lods.begin(), model.lods.end()),
      octree_(model.octree.begin(), model.octree.end()),
      hierarchy_(point_hierarchy(model.point_tree, model.patches, model.info->max_surfel_radius)),
      surfels_(device, model.surfels.size(), gpu::MemoryUse::device, "surfels"),
      pool_(device) {
    const auto buffer = [&](const char* name, VkBufferUsageFlags usage, std::span<const std::byte> bytes) {
        gpu::Buffer result(device, {.size = bytes.size(), .usage = usage, .name = name});
        gpu::upload(device, result, bytes);
        return result;
    };
    vertices_ = buffer("vertices", VK_BUFFER_USAGE_VERTEX_BUFFER_BIT, std::as_bytes(model.vertices));
    indices_ = buffer("indices", VK_BUFFER_USAGE_INDEX_BUFFER_BIT, std::as_bytes(model.indices));
    gpu::upload(device, surfels_.buffer(), std::as_bytes(model.surfels));
    if (!hierarchy_.empty() && surfels_.mapped().empty())
        surfel_copy_.assign(model.surfels.begin(), model.surfels.end());
    make_ellipses(model);
    create_materials(device, model);
}

void GpuModel::make_ellipses(const ModelView& model) {
    ellipses_.resize(model.point_tree.size());
    tbb::parallel_for(std::size_t{0}, ellipses_.size(), [&](std::size_t i) {
        const format::PointNode& node = model.point_tree[i];
        ellipses_[i] = ellipse_record(node, model.surfels[node.first_surfel].patch);
    });
}

void GpuModel::create_materials(gpu::Device& device, const ModelView& model) {
    for (const format::Texture& texture : model.textures)
        images_.push_back(create_texture(device, texture, model.texels));
    const std::array<std::byte, 4> white{std::byte{255}, std::byte{255}, std::byte{255}, std::byte{255}};
    images_.push_back(create_texture(device, {1, 1, 1, 0, 0, white.size()}, white));
    sampler_ = gpu::create_sampler(device, {.max_anisotropy = kAnisotropy});
    set_layout_ = material_set_layout(device);
    for (const format::Material& material : model.materials) {
        const std::size_t image = material.texture == format::kNoTexture ? images_.size() - 1 : material.texture;
        material_sets_.push_back(pool_.allocate(set_layout_));
        gpu::DescriptorWriter(material_sets_.back())
            .sampled_image(0, images_[image].view(), sampler_.get())
            .write(device);
    }
}

std::span<const format::Surfel> GpuModel::host_surfels() const {
    return surfel_copy_.empty() ? surfels_.mapped() : std::span<const format::Surfel>(surfel_copy_);
}

Box GpuModel::bounds() const {
    Box box;
    for (const float* corner : {info_.bounds_min, info_.bounds_max})
        box.extend(glm::dvec3(corner[0], corner[1], corner[2]) * info_.source_scale +
                   glm::dvec3(info_.source_offset[0], info_.source_offset[1], info_.source_offset[2]));
    return box;
}

}  // namespace splice
