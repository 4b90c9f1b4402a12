// What the passes of the tile backend hand to each other (shaders/glsl/include/tile.glsl), kept from frame to frame and
// grown when a frame needs more.
#pragma once

#include "engine/passes/frame_data.h"
#include "engine/passes/shader_types.h"
#include "engine/render_graph/executor/executor.h"
#include "engine/render_graph/graph.h"
#include "engine/vulkan/buffer.h"

#include <cstdint>

namespace splice {

/// Pixels; TILE of tile.glsl.
inline constexpr std::uint32_t kTileWidth = 8, kTileHeight = 4;
/// Bytes of TileSplat of tile.glsl.
inline constexpr std::uint64_t kTileRecordBytes = 96;
/// What a workgroup takes: surfels of tile_setup.comp (SHARE); chunks of tile_count.comp and tile_list.comp, tiles of
/// tile_scan.comp (local_size_x).
inline constexpr std::uint32_t kSetupShare = 64, kChunkGroup = 8, kScanGroup = 64;

/// The buffers of one frame as its graph knows them.
struct TileHandles {
    graph::BufferHandle records, bounds, counts, starts, lists, report;
};

class TileBuffers {
  public:
    explicit TileBuffers(gpu::Device& device);

    /// Whether a frame of so many splats fits the device's limits at all.
    bool fits(const FrameSettings& settings, std::uint64_t splats, std::uint64_t entries) const;
    /// Makes room for a frame; no submitted work may still use the one before.
    void prepare(const FrameSettings& settings, std::uint64_t splats, std::uint64_t entries);
    TileHandles import(graph::Graph& graph, graph::Bindings& bindings) const;

    const TileUniforms& uniforms() const { return values_; }
    const gpu::Buffer& uniform_buffer() const { return uniforms_; }
    /// Bytes of the counts that the frame uses.
    std::uint64_t count_bytes() const;
    /// List entries that the last frame needed; more than it had room for: it is not complete.
    std::uint64_t entries_needed() const;
    /// As if there had been no frame before.
    void forget();
    std::uint64_t capacity() const { return values_.capacity; }

  private:
    void grow(gpu::Buffer& buffer, const char* name, std::uint64_t bytes);

    gpu::Device& device_;
    gpu::Buffer uniforms_, records_, bounds_, counts_, starts_, lists_, report_;
    TileUniforms values_{};
};

}  // namespace splice
