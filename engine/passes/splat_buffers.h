// What the compute passes over splats hand to each other (shaders/glsl/include/tile.glsl), kept from frame to frame and
// grown when a frame needs more.
#pragma once

#include "engine/passes/frame_data.h"
#include "engine/passes/shader_types.h"
#include "engine/passes/splat_plan.h"
#include "engine/render_graph/executor/executor.h"
#include "engine/render_graph/graph.h"
#include "engine/vulkan/buffer.h"
#include "engine/vulkan/descriptor.h"

#include <cstdint>
#include <span>

namespace splice {

/// Of tile.glsl, by the same names: pixels; surfels; splats; texels a splat; words of a mask; groups of a cell.
inline constexpr std::uint32_t kTileWidth = 8, kTileHeight = 4;
inline constexpr std::uint32_t kTileGroup = 64, kTileBlock = 8, kTileRecordTexels = 4;
inline constexpr std::uint32_t kTileSegmentWords = 8, kTileFusedGroups = 264;
/// local_size_x of tile_cells.comp.
inline constexpr std::uint32_t kTileCellsGroup = 64;

/// CELLS_* of tile.glsl: lists of cells, each with a dispatch.
enum class TileCells : std::uint32_t { kOthers, kClose, kSegmented };
inline constexpr std::uint32_t kTileCellLists = 3;

/// The buffers of one frame as its graph knows them.
struct SplatHandles {
    graph::BufferHandle records, blocks, masks, cells, list;
};

/// What one batch of a frame needs room for, in groups of surfels.
struct SplatRoom {
    std::uint64_t groups = 0;  // all
    std::uint64_t tiled = 0, listed = 0;
};

class SplatBuffers {
  public:
    explicit SplatBuffers(gpu::Device& device);

    /// Groups that one batch may have: what texel buffers hold, and at most `most` where that is not 0.
    std::uint64_t most_groups(std::uint64_t most) const;
    /// `sources`: of setup, for all batches. `segmented`: tiles are gathered in segments, whatever their number. No
    /// submitted work may still use the frame before.
    void prepare(const FrameSettings& settings, const SplatRoom& room, std::span<const SplatGroup> sources,
                 bool segmented);
    SplatHandles import(graph::Graph& graph, graph::Bindings& bindings) const;
    /// Empties masks and cells.
    void clear_tiles(VkCommandBuffer commands) const;

    /// Set 2 of tile.glsl.
    const gpu::DescriptorSetLayout& layout() const { return layout_; }
    VkDescriptorSet set() const { return set_; }
    const gpu::Buffer& list() const { return list_; }
    const TileUniforms& uniforms() const { return values_; }
    std::uint32_t cells() const { return values_.cells_x * values_.cells_y; }

  private:
    bool grow(gpu::Buffer& buffer, const char* name, std::uint64_t bytes, VkBufferUsageFlags usage,
              gpu::MemoryUse memory = gpu::MemoryUse::device);

    gpu::Device& device_;
    gpu::DescriptorSetLayout layout_;
    gpu::DescriptorPool pool_;
    gpu::Buffer uniforms_, sources_, records_, blocks_, masks_, cells_, list_;
    gpu::UniqueBufferView record_view_, block_view_, mask_view_, list_view_;
    VkDescriptorSet set_ = VK_NULL_HANDLE;
    TileUniforms values_{};
};

/// Offsets in bytes into the cell buffer.
constexpr std::uint64_t tile_dispatch(TileCells cells) {
    return 16 * static_cast<std::uint64_t>(cells);
}
inline constexpr std::uint64_t kTileCellList = 16 * kTileCellLists;
/// And into the list: a VkDrawIndirectCommand, then a number a group.
inline constexpr std::uint64_t kListDraw = 0, kListGroups = 16;

}  // namespace splice
