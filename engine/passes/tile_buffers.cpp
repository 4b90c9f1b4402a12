#include "engine/passes/tile_buffers.h"

#include <glm/gtc/type_ptr.hpp>

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

constexpr std::uint64_t divided_up(std::uint64_t value, std::uint64_t by) {
    return (value + by - 1) / by;
}

}  // namespace

TileBuffers::TileBuffers(gpu::Device& device)
    : device_(device),
      uniforms_(device, {.size = sizeof(TileUniforms),
                         .usage = VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT,
                         .memory = gpu::MemoryUse::upload,
                         .name = "tile uniforms"}) {}

std::uint64_t TileBuffers::most_groups(std::uint64_t most) const {
    const std::uint64_t held = device_.limits().maxTexelBufferElements / (kTileGroup * (kTileRecordTexels + 2));
    const std::uint64_t all = std::clamp<std::uint64_t>(held, 1, kMostGroups);
    return most == 0 ? all : std::min(most, all);
}

void TileBuffers::prepare(const FrameSettings& settings, std::uint64_t groups, bool segmented,
                          const VkClearValue& background) {
    groups = std::max<std::uint64_t>(groups, 1);
    const std::uint64_t words = divided_up(groups, 32);
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
               .padding = {},
               .background = glm::make_vec4(background.color.float32)};
    std::memcpy(uniforms_.mapped().data(), &values_, sizeof values_);

    constexpr VkBufferUsageFlags written = VK_BUFFER_USAGE_STORAGE_TEXEL_BUFFER_BIT;
    constexpr VkBufferUsageFlags read = VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT;
    if (grow(records_, "splat records", groups * kTileGroup * (kTileRecordTexels + 2) * kTexelBytes, written | read))
        record_view_ = gpu::create_texel_view(device_, records_, VK_FORMAT_R32G32B32A32_UINT);
    if (grow(blocks_, "splat blocks", groups * kBlocks * kBoundsBytes, written | read))
        block_view_ = gpu::create_texel_view(device_, blocks_, VK_FORMAT_R32G32_UINT);
    if (grow(masks_, "tile masks", cells() * words * kWordBytes, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | read))
        mask_view_ = gpu::create_texel_view(device_, masks_, VK_FORMAT_R32_UINT);
    grow(cells_, "tile cells", kTileCellList + 2 * cells() * kWordBytes,
         VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT);
}

bool TileBuffers::grow(gpu::Buffer& buffer, const char* name, std::uint64_t bytes, VkBufferUsageFlags usage) {
    if (buffer && buffer.size() >= bytes) return false;
    buffer = gpu::Buffer(device_, {.size = bytes, .usage = usage, .name = name});
    return true;
}

TileHandles TileBuffers::import(graph::Graph& graph, graph::Bindings& bindings) const {
    const auto scratch = [&](const char* name, const gpu::Buffer& buffer) {
        const graph::BufferHandle handle = graph.import_buffer(name, {buffer.size()}, {.wanted = false});
        bindings.bind(handle, buffer);
        return handle;
    };
    return {.records = scratch("splat_records", records_),
            .blocks = scratch("splat_blocks", blocks_),
            .masks = scratch("tile_masks", masks_),
            .cells = scratch("tile_cells", cells_)};
}

void TileBuffers::write(gpu::DescriptorWriter& writer) const {
    writer.uniform_buffer(0, uniforms_.handle())
        .storage_texels(1, record_view_.get())
        .storage_texels(2, block_view_.get())
        .storage_buffer(3, masks_.handle())
        .sampled_texels(4, record_view_.get())
        .storage_buffer(5, cells_.handle())
        .sampled_texels(6, block_view_.get())
        .sampled_texels(7, mask_view_.get());
}

void TileBuffers::clear(VkCommandBuffer commands) const {
    const std::uint64_t tiles =
        (std::uint64_t{1} << 2 * values_.cell_shift) / (std::uint64_t{kTileWidth} * kTileHeight);
    const std::array<std::uint32_t, 8> dispatches{static_cast<std::uint32_t>(tiles), 0, 1, 0,
                                                  static_cast<std::uint32_t>(tiles), 0, 1, 0};
    static_assert(sizeof dispatches == kTileCellList);
    vkCmdFillBuffer(commands, masks_.handle(), 0, std::uint64_t{cells()} * values_.words * kWordBytes, 0);
    vkCmdUpdateBuffer(commands, cells_.handle(), 0, sizeof dispatches, dispatches.data());
    vkCmdFillBuffer(commands, cells_.handle(), kTileCellList, std::uint64_t{cells()} * kWordBytes, 0);
}

}  // namespace splice
