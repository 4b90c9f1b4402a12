#include "engine/scene/surfel_store.h"

#include "preprocess/model_format/model_format.h"

#include <algorithm>

namespace splice {

namespace {

// Synchronisation validation (1.3.239) takes the four vertices of an instance for four records of the instance's
// buffer.
constexpr std::uint64_t kPadding = 3;

std::uint64_t stride_of(SurfelRecords records) {
    return records == SurfelRecords::kPacked ? sizeof(format::PackedSurfel) : sizeof(format::Surfel);
}

gpu::BufferOptions buffer_options(std::uint64_t surfels, std::uint64_t stride, gpu::MemoryUse memory,
                                  const std::string& name) {
    return {.size = (surfels + kPadding) * stride,
            .usage = VK_BUFFER_USAGE_VERTEX_BUFFER_BIT | VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT,
            .memory = memory,
            .name = name};
}

}  // namespace

gpu::DescriptorSetLayout surfel_set_layout(const gpu::Device& device) {
    return {device, {{0, VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER, VK_SHADER_STAGE_COMPUTE_BIT, 1}}};
}

SurfelStore::SurfelStore(gpu::Device& device, std::uint64_t surfels, SurfelRecords records, gpu::MemoryUse memory,
                         const std::string& name)
    : records_(records),
      stride_(stride_of(records)),
      capacity_(surfels),
      buffer_(device, buffer_options(surfels, stride_, memory, name)),
      layout_(surfel_set_layout(device)),
      pool_(device) {
    const std::uint64_t texels = stride_ / sizeof(std::uint32_t[4]);
    constexpr std::uint64_t kAlignment = 16;  // surfels: no device asks for texel offsets of more than 256 bytes
    const std::uint64_t most = device.limits().maxTexelBufferElements / texels / kAlignment * kAlignment;
    for (std::uint64_t first = 0; first < surfels; first += most) {
        const std::uint64_t count = std::min(most, surfels - first);
        views_.push_back(
            gpu::create_texel_view(device, buffer_, VK_FORMAT_R32G32B32A32_UINT, first * stride_, count * stride_));
        chunks_.push_back({pool_.allocate(layout_), first, count});
        gpu::DescriptorWriter(chunks_.back().set).sampled_texels(0, views_.back().get()).write(device);
    }
}

std::span<format::Surfel> SurfelStore::mapped() const {
    const std::span<std::byte> bytes = buffer_.mapped();
    if (bytes.empty() || is_packed()) return {};
    return {reinterpret_cast<format::Surfel*>(bytes.data()), capacity_};
}

}  // namespace splice
