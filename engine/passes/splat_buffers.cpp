#include "engine/passes/splat_buffers.h"

#include <algorithm>
#include <array>
#include <cstring>

namespace splice {

namespace {

constexpr std::uint64_t kWordBytes = 4, kTexelBytes = 16, kBoundsBytes = 8;
constexpr std::uint64_t kBlocks = kTileGroup / kTileBlock;
// Cells as small as this keep what a tile must look at few; more masks than this are slow to clear.
constexpr std::uint32_t kSmallestCellShift = 4, kLargestCellShift = 10;
constexpr std::uint64_t kMostMaskBytes = std::uint64_t{1} << 24, kMostCells = std::uint64_t{1} << 15;
// Scratch of 400 MiB; larger frames take turns.
constexpr std::uint64_t kMostGroups = std::uint64_t{1} << 16;

constexpr VkShaderStageFlags kStages = VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_COMPUTE_BIT;

constexpr std::uint64_t divided_up(std::uint64_t value, std::uint64_t by) {
    return (value + by - 1) / by;
}

}  // namespace

SplatBuffers::SplatBuffers(gpu::Device& device)
    : device_(device),
      layout_(device, {{0, VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, kStages},
                       {1, VK_DESCRIPTOR_TYPE_STORAGE_TEXEL_BUFFER, VK_SHADER_STAGE_COMPUTE_BIT},
                       {2, VK_DESCRIPTOR_TYPE_STORAGE_TEXEL_BUFFER, VK_SHADER_STAGE_COMPUTE_BIT},
                       {3, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, VK_SHADER_STAGE_COMPUTE_BIT},
                       {4, VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER, kStages},
                       {5, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, VK_SHADER_STAGE_COMPUTE_BIT},
                       {6, VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER, VK_SHADER_STAGE_COMPUTE_BIT},
                       {7, VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER, VK_SHADER_STAGE_COMPUTE_BIT},
                       {8, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, VK_SHADER_STAGE_COMPUTE_BIT},
                       {9, VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER, VK_SHADER_STAGE_VERTEX_BIT},
                       {10, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, VK_SHADER_STAGE_COMPUTE_BIT}}),
      pool_(device),
      uniforms_(device, {.size = sizeof(TileUniforms),
                         .usage = VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT,
                         .memory = gpu::MemoryUse::upload,
                         .name = "tile uniforms"}) {}

std::uint64_t SplatBuffers::most_groups(std::uint64_t most) const {
    const std::uint64_t held = device_.limits().maxTexelBufferElements / (kTileGroup * (kTileRecordTexels + 2));
    const std::uint64_t all = std::clamp<std::uint64_t>(held, 1, kMostGroups);
    return most == 0 ? all : std::min(most, all);
}

void SplatBuffers::prepare(const FrameSettings& settings, const SplatRoom& room, std::span<const SplatGroup> sources,
                           bool segmented) {
    const std::uint64_t groups = std::max<std::uint64_t>(room.groups, 1);
    const std::uint64_t words = std::max<std::uint64_t>(divided_up(room.tiled, 32), 1);
    std::uint32_t shift = kSmallestCellShift;
    const auto across = [&](std::uint32_t pixels) { return divided_up(pixels, std::uint64_t{1} << shift); };
    const auto cells = [&] { return across(settings.width) * across(settings.height); };
    while (shift < kLargestCellShift && (cells() > kMostCells || cells() * words * kWordBytes > kMostMaskBytes))
        ++shift;
    values_ = {.cells_x = static_cast<std::uint32_t>(across(settings.width)),
               .cells_y = static_cast<std::uint32_t>(across(settings.height)),
               .cell_shift = shift,
               .words = static_cast<std::uint32_t>(words),
               .segmented = segmented ? 1u : 0u,
               .first_solid = static_cast<std::uint32_t>(groups * kTileGroup * kTileRecordTexels),
               .first_listed = static_cast<std::uint32_t>(kListGroups / kWordBytes + groups),
               .padding = {}};
    std::memcpy(uniforms_.mapped().data(), &values_, sizeof values_);

    constexpr VkBufferUsageFlags written = VK_BUFFER_USAGE_STORAGE_TEXEL_BUFFER_BIT;
    constexpr VkBufferUsageFlags storage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;
    constexpr VkBufferUsageFlags read = VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT;
    constexpr VkBufferUsageFlags indirect = VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT;
    bool grown = set_ == VK_NULL_HANDLE;
    const auto grow_texels = [&](gpu::Buffer& buffer, gpu::UniqueBufferView& view, const char* name,
                                 std::uint64_t bytes, VkFormat format, VkBufferUsageFlags usage) {
        if (!grow(buffer, name, bytes, usage)) return;
        view = gpu::create_texel_view(device_, buffer, format);
        grown = true;
    };
    grow_texels(records_, record_view_, "splat records", groups * kTileGroup * (kTileRecordTexels + 2) * kTexelBytes,
                VK_FORMAT_R32G32B32A32_UINT, written | read);
    grow_texels(blocks_, block_view_, "splat blocks", groups * kBlocks * kBoundsBytes, VK_FORMAT_R32G32_UINT,
                written | read);
    grow_texels(masks_, mask_view_, "tile masks", cells() * words * kWordBytes, VK_FORMAT_R32_UINT, storage | read);
    grow_texels(list_, list_view_, "splat list", kListGroups + (groups + room.listed * kTileGroup) * kWordBytes,
                VK_FORMAT_R32_UINT, storage | read | indirect);
    grown =
        grow(cells_, "tile cells", kTileCellList + (1 + kTileCellLists) * cells() * kWordBytes, storage | indirect) ||
        grown;
    grown = grow(sources_, "splat groups", std::max<std::uint64_t>(sources.size_bytes(), sizeof(SplatGroup)), storage,
                 gpu::MemoryUse::upload) ||
            grown;
    if (!sources.empty()) std::memcpy(sources_.mapped().data(), sources.data(), sources.size_bytes());
    if (!grown) return;
    pool_.reset();
    set_ = pool_.allocate(layout_);
    gpu::DescriptorWriter(set_)
        .uniform_buffer(0, uniforms_.handle())
        .storage_texels(1, record_view_.get())
        .storage_texels(2, block_view_.get())
        .storage_buffer(3, masks_.handle())
        .sampled_texels(4, record_view_.get())
        .storage_buffer(5, cells_.handle())
        .sampled_texels(6, block_view_.get())
        .sampled_texels(7, mask_view_.get())
        .storage_buffer(8, list_.handle())
        .sampled_texels(9, list_view_.get())
        .storage_buffer(10, sources_.handle())
        .write(device_);
}

bool SplatBuffers::grow(gpu::Buffer& buffer, const char* name, std::uint64_t bytes, VkBufferUsageFlags usage,
                        gpu::MemoryUse memory) {
    if (buffer && buffer.size() >= bytes) return false;
    buffer = gpu::Buffer(device_, {.size = bytes, .usage = usage, .memory = memory, .name = name});
    return true;
}

SplatHandles SplatBuffers::import(graph::Graph& graph, graph::Bindings& bindings) const {
    const auto scratch = [&](const char* name, const gpu::Buffer& buffer) {
        const graph::BufferHandle handle = graph.import_buffer(name, {buffer.size()}, {.wanted = false});
        bindings.bind(handle, buffer);
        return handle;
    };
    return {.records = scratch("splat_records", records_),
            .blocks = scratch("splat_blocks", blocks_),
            .masks = scratch("tile_masks", masks_),
            .cells = scratch("tile_cells", cells_),
            .list = scratch("splat_list", list_)};
}

void SplatBuffers::clear_tiles(VkCommandBuffer commands) const {
    const std::uint64_t tiles =
        (std::uint64_t{1} << 2 * values_.cell_shift) / (std::uint64_t{kTileWidth} * kTileHeight);
    std::array<std::array<std::uint32_t, 4>, kTileCellLists> dispatches;
    dispatches.fill({static_cast<std::uint32_t>(tiles), 0, 1, 0});
    static_assert(sizeof dispatches == kTileCellList);
    vkCmdFillBuffer(commands, masks_.handle(), 0, std::uint64_t{cells()} * values_.words * kWordBytes, 0);
    vkCmdUpdateBuffer(commands, cells_.handle(), 0, sizeof dispatches, dispatches.data());
    vkCmdFillBuffer(commands, cells_.handle(), kTileCellList, std::uint64_t{cells()} * kWordBytes, 0);
}

}  // namespace splice
