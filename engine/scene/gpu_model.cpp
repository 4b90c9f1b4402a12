#include "engine/scene/gpu_model.h"

#include "engine/scene/ellipse_record.h"
#include "engine/vulkan/transfer.h"
#include "preprocess/model_format/packed_surfel.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <utility>

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

/// Unit-box units. The triangles of all patches, those of surfels included, are in the file; of a cloud, and where a
/// patch has none, there is nothing but the bounds of what is drawn.
std::pair<glm::vec3, glm::vec3> surface_bounds(const ModelView& model) {
    const auto vector = [](const float(&v)[3]) { return glm::vec3(v[0], v[1], v[2]); };
    const bool all_triangles = std::ranges::all_of(model.patches, [&](const format::Patch& patch) {
        return patch.lod_count > 0 && model.lods[patch.first_lod].index_count > 0;
    });
    if (!all_triangles || model.vertices.empty())
        return {vector(model.info->bounds_min), vector(model.info->bounds_max)};
    glm::vec3 low = vector(model.vertices.front().position), high = low;
    for (const format::Vertex& vertex : model.vertices) {
        low = glm::min(low, vector(vertex.position));
        high = glm::max(high, vector(vertex.position));
    }
    return {low, high};
}

std::span<const std::byte> records_of(const ModelView& model) {
    return model.is_packed() ? std::as_bytes(model.packed_surfels) : std::as_bytes(model.surfels);
}

// What records hold of it. Packed ones need not be read for that.
std::uint16_t patch_of(const ModelView& model, std::uint64_t surfel) {
    return model.is_packed() ? static_cast<std::uint16_t>(surfel / kPackedBlock) : model.surfels[surfel].patch;
}

}  // namespace

gpu::DescriptorSetLayout material_set_layout(const gpu::Device& device) {
    return {device, {{0, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, VK_SHADER_STAGE_FRAGMENT_BIT, 1}}};
}

GpuModel::GpuModel(gpu::Device& device, const ModelView& model, const Paging& paging)
    : GpuModel(device, model, paging, unpack_point_tree(model.point_tree),
               model.is_packed() || paging.owner ? MergedSurfels{} : merge_surfels(model.surfels, model.patches)) {}

GpuModel::GpuModel(gpu::Device& device, const ModelView& model, const Paging& paging,
                   const std::vector<format::PointNode>& tree, MergedSurfels merged)
    : info_(*model.info),
      patches_(model.patches.begin(), model.patches.end()),
      lods_(model.lods.begin(), model.lods.end()),
      octree_(model.octree.begin(), model.octree.end()),
      group_contents_(patch_group_contents(octree_, patches_, lods_)),
      triangle_bounds_(model),
      hierarchy_(point_hierarchy(tree, model.patches, model.info->max_surfel_radius)),
      surfel_count_(model.surfel_count()),
      paged_(paging.owner && !hierarchy_.empty() && records_of(model).size() > paging.limit),
      surfels_(device, paged_ ? 0 : model.surfel_count() + merged.records.size(),
               model.is_packed() ? SurfelRecords::kPacked : SurfelRecords::kPlain, gpu::MemoryUse::device, "surfels"),
      pool_(device) {
    const auto [low, high] = surface_bounds(model);
    bounds_ = to_source(low, high);
    drawn_bounds_ = to_source({info_.bounds_min[0], info_.bounds_min[1], info_.bounds_min[2]},
                              {info_.bounds_max[0], info_.bounds_max[1], info_.bounds_max[2]});
    const auto buffer = [&](const char* name, VkBufferUsageFlags usage, std::span<const std::byte> bytes) {
        gpu::Buffer result(device, {.size = bytes.size(), .usage = usage, .name = name});
        gpu::upload(device, result, bytes);
        return result;
    };
    vertices_ = buffer("vertices", VK_BUFFER_USAGE_VERTEX_BUFFER_BIT, std::as_bytes(model.vertices));
    indices_ = buffer("indices", VK_BUFFER_USAGE_INDEX_BUFFER_BIT, std::as_bytes(model.indices));
    const auto records = paged_ ? std::span<const std::byte>() : records_of(model);
    gpu::upload(device, surfels_.buffer(), records);
    gpu::upload(device, surfels_.buffer(), std::as_bytes(std::span(merged.records)), records.size());
    if (!paged_) surfels_.set_bounds(bound_surfels(model, merged.records));
    merged_levels_ = std::move(merged.levels);
    for (std::vector<MergedRange>& level : merged_levels_)
        for (MergedRange& range : level)
            range.first += surfel_count_;
    if (!paged_ && !hierarchy_.empty() && surfels_.buffer().mapped().empty())
        record_copy_.assign(records.begin(), records.end());
    make_ellipses(model, tree);
    if (paged_) page(model, paging);
    create_materials(device, model);
}

void GpuModel::make_ellipses(const ModelView& model, const std::vector<format::PointNode>& tree) {
    ellipses_.resize(tree.size());
    tbb::parallel_for(std::size_t{0}, ellipses_.size(), [&](std::size_t i) {
        const format::PointNode& node = tree[i];
        ellipses_[i] = ellipse_record(node, patch_of(model, node.first_surfel));
    });
}

void GpuModel::create_materials(gpu::Device& device, const ModelView& model) {
    for (const format::Texture& texture : model.textures)
        images_.push_back(create_texture(device, texture, model.texels));
    const std::array<std::byte, 4> white{std::byte{255}, std::byte{255}, std::byte{255}, std::byte{255}};
    images_.push_back(create_texture(device, {1, 1, 1, 0, 0, white.size()}, white));
    sampler_ = gpu::create_sampler(device, {.max_anisotropy = kAnisotropy});
    // White is white however it is sampled, and this is the cheapest way: a software device spends more on anisotropy
    // than on all else of a fragment.
    plain_sampler_ =
        gpu::create_sampler(device, {.filter = VK_FILTER_NEAREST, .mipmap_mode = VK_SAMPLER_MIPMAP_MODE_NEAREST});
    set_layout_ = material_set_layout(device);
    for (const format::Material& material : model.materials) {
        const bool plain = material.texture == format::kNoTexture;
        const std::size_t image = plain ? images_.size() - 1 : material.texture;
        material_sets_.push_back(pool_.allocate(set_layout_));
        gpu::DescriptorWriter(material_sets_.back())
            .sampled_image(0, images_[image].view(), plain ? plain_sampler_.get() : sampler_.get())
            .write(device);
    }
}

void GpuModel::page(const ModelView& model, const Paging& paging) {
    std::vector<std::uint32_t> level(hierarchy_.size(), 1);
    for (std::uint32_t i = 0; i < level.size(); ++i) {
        const std::uint32_t children = hierarchy_.child_counts[i];
        if (children == 0) leaves_.push_back({i, level[i]});
        for (std::uint32_t child = 0; child < children; ++child)
            level[hierarchy_.first_child[i] + child] = level[i] + 1;
    }
    std::ranges::sort(leaves_, {}, [&](const TreeLeaf& leaf) { return hierarchy_.first_surfel[leaf.node]; });
    const std::span<const std::byte> records = records_of(model);
    if (paging.release) paging.release(records);
    pager_ = std::make_unique<SurfelPager>(records.size(), paging.limit,
                                           [records, paging](std::uint64_t first, std::span<std::byte> bytes) {
                                               const auto source = records.subspan(first, bytes.size());
                                               std::ranges::copy(source, bytes.begin());
                                               if (paging.release) paging.release(source);
                                           });
}

void GpuModel::copy_surfels(std::uint64_t first, std::span<format::Surfel> copies) const {
    constexpr std::uint64_t kBlock = SurfelPager::kBlockBytes;
    static_assert(kBlock % sizeof(format::Surfel) == 0);
    if (pager_) {
        const std::uint64_t stride = surfels_.stride();
        while (!copies.empty()) {
            const std::uint64_t at = first * stride, block = at / kBlock;
            const std::uint64_t count = std::min<std::uint64_t>(copies.size(), ((block + 1) * kBlock - at) / stride);
            const auto records = pager_->find(static_cast<std::uint32_t>(block)).subspan(at % kBlock, count * stride);
            unpack_surfels(records, first, copies.first(count));
            copies = copies.subspan(count);
            first += count;
        }
        return;
    }
    const std::span<const std::byte> records =
        record_copy_.empty() ? std::span<const std::byte>(surfels_.buffer().mapped()) : record_copy_;
    unpack_surfels(records.subspan(first * surfels_.stride(), copies.size() * surfels_.stride()), first, copies);
}

void GpuModel::unpack_surfels(std::span<const std::byte> records, std::uint64_t first,
                              std::span<format::Surfel> copies) const {
    const std::byte* at = records.data();
    if (!surfels_.is_packed()) {
        std::memcpy(copies.data(), at, copies.size_bytes());
        return;
    }
    for (format::Surfel& copy : copies) {
        format::PackedSurfel packed;
        std::memcpy(&packed, at, sizeof packed);
        copy = unpack_surfel(packed, static_cast<std::uint16_t>(first++ / kPackedBlock));
        at += sizeof packed;
    }
}

Box GpuModel::to_source(const glm::dvec3& low, const glm::dvec3& high) const {
    const glm::dvec3 offset(info_.source_offset[0], info_.source_offset[1], info_.source_offset[2]);
    return {low * info_.source_scale + offset, high * info_.source_scale + offset};
}

}  // namespace splice
