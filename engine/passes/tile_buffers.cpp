#include "engine/passes/tile_buffers.h"

#include <algorithm>
#include <cstring>

namespace splice {

namespace {

constexpr std::uint64_t kBoundsBytes = 8, kIndexBytes = 4;
// Chunks are what orders the lists. Few make little work for the prefix sum, many make work for all of a device's
// units.
constexpr std::uint64_t kFewestChunks = 16, kMostChunks = 64, kChunkSplats = 4096;

struct Sizes {
    std::uint64_t tiles_x, tiles_y, chunks, largest;
};

Sizes sizes_of(const FrameSettings& settings, std::uint64_t splats, std::uint64_t entries) {
    Sizes sizes{};
    sizes.tiles_x = (settings.width + kTileWidth - 1) / kTileWidth;
    sizes.tiles_y = (settings.height + kTileHeight - 1) / kTileHeight;
    sizes.chunks = std::clamp(splats / kChunkSplats / 8 * 8, kFewestChunks, kMostChunks);
    const std::uint64_t tiles = sizes.tiles_x * sizes.tiles_y;
    sizes.largest = std::max({splats * kTileRecordBytes, tiles * sizes.chunks * kIndexBytes, entries * kIndexBytes});
    return sizes;
}

}  // namespace

TileBuffers::TileBuffers(gpu::Device& device)
    : device_(device),
      uniforms_(device, {.size = sizeof(TileUniforms),
                         .usage = VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT,
                         .memory = gpu::MemoryUse::upload,
                         .name = "tile uniforms"}),
      report_(device, {.size = kIndexBytes,
                       .usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT,
                       .memory = gpu::MemoryUse::readback,
                       .name = "tile report"}) {
    forget();
}

bool TileBuffers::fits(const FrameSettings& settings, std::uint64_t splats, std::uint64_t entries) const {
    return sizes_of(settings, splats, entries).largest <= device_.limits().maxStorageBufferRange;
}

void TileBuffers::prepare(const FrameSettings& settings, std::uint64_t splats, std::uint64_t entries) {
    const Sizes sizes = sizes_of(settings, splats, entries);
    const std::uint64_t tiles = sizes.tiles_x * sizes.tiles_y;
    grow(records_, "splat records", splats * kTileRecordBytes);
    grow(bounds_, "splat bounds", splats * kBoundsBytes);
    grow(counts_, "tile counts", tiles * sizes.chunks * kIndexBytes);
    grow(starts_, "tile starts", (tiles + 1) * kIndexBytes);
    grow(lists_, "tile lists", entries * kIndexBytes);
    values_ = {.tiles_x = static_cast<std::uint32_t>(sizes.tiles_x),
               .tiles_y = static_cast<std::uint32_t>(sizes.tiles_y),
               .splats = static_cast<std::uint32_t>(splats),
               .chunks = static_cast<std::uint32_t>(sizes.chunks),
               .capacity = static_cast<std::uint32_t>(lists_.size() / kIndexBytes)};
    std::memcpy(uniforms_.mapped().data(), &values_, sizeof values_);
}

void TileBuffers::grow(gpu::Buffer& buffer, const char* name, std::uint64_t bytes) {
    if (buffer && buffer.size() >= bytes) return;
    // Some more than is needed, so that a model that turns does not make new ones every frame.
    const std::uint64_t ample = std::min<std::uint64_t>(bytes + bytes / 4, device_.limits().maxStorageBufferRange);
    buffer = gpu::Buffer(device_, {.size = std::max<std::uint64_t>(ample / kTileRecordBytes * kTileRecordBytes, bytes),
                                   .usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT,
                                   .name = name});
}

TileHandles TileBuffers::import(graph::Graph& graph, graph::Bindings& bindings) const {
    const auto scratch = [&](const char* name, const gpu::Buffer& buffer) {
        const graph::BufferHandle handle = graph.import_buffer(name, {buffer.size()}, {.wanted = false});
        bindings.bind(handle, buffer);
        return handle;
    };
    TileHandles handles{
        .records = scratch("splat_records", records_),
        .bounds = scratch("splat_bounds", bounds_),
        .counts = scratch("tile_counts", counts_),
        .starts = scratch("tile_starts", starts_),
        .lists = scratch("tile_lists", lists_),
        .report = graph.import_buffer("tile_report", {report_.size()}, {.after = graph::external::host_read()})};
    bindings.bind(handles.report, report_);
    return handles;
}

std::uint64_t TileBuffers::count_bytes() const {
    return std::uint64_t{values_.tiles_x} * values_.tiles_y * values_.chunks * kIndexBytes;
}

std::uint64_t TileBuffers::entries_needed() const {
    std::uint32_t needed = 0;
    std::memcpy(&needed, report_.mapped().data(), sizeof needed);
    return needed;
}

void TileBuffers::forget() {
    const std::uint32_t none = 0;
    std::memcpy(report_.mapped().data(), &none, sizeof none);
}

}  // namespace splice
