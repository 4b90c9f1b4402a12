#include "engine/passes/left_out_cells.h"

#include <algorithm>
#include <cstring>

namespace splice {

namespace {

// Of a dispatch in the cell buffer: tiles of a cell, cells, 1.
constexpr std::uint64_t kCellsOfDispatch = 4;

}  // namespace

std::array<SplatPrograms::Program, 2> segment_programs(const SplatPrograms::Variant& variant) {
    using Stage = SplatPrograms::Stage;
    return {{{Stage::kTileVisibility, variant}, {Stage::kTileAttributes, variant}}};
}

LeftOutCells::LeftOutCells(gpu::Device& device, SplatPrograms& programs)
    : programs_(programs),
      counts_(device, {.size = kTileCellList,
                       .usage = VK_BUFFER_USAGE_TRANSFER_DST_BIT,
                       .memory = gpu::MemoryUse::readback,
                       .name = "tile counts"}) {}

bool LeftOutCells::begin(graph::Graph& graph, graph::Bindings& bindings, graph::BufferHandle cells,
                         const FrameSettings& settings, const SplatPrograms::Variant& variant) {
    settings_ = settings;
    variant_ = variant;
    left_out_ = !std::ranges::all_of(segment_programs(variant), [&](const SplatPrograms::Program& program) {
        return programs_.is_made(settings, program);
    });
    if (!left_out_) return false;
    const graph::BufferHandle counts =
        graph.import_buffer("tile_counts", {counts_.size()}, {.after = graph::external::host_read()});
    bindings.bind(counts, counts_);
    graph::Pass pass = graph.add_pass("tile_counts", graph::PassKind::transfer);
    pass.transfer_read(cells);
    pass.transfer_write(counts, graph::Contents::discard());
    pass.record([cells, counts](const graph::PassContext& context) {
        const VkBufferCopy head{0, 0, kTileCellList};
        vkCmdCopyBuffer(context.commands, context.buffer(cells), context.buffer(counts), 1, &head);
    });
    return true;
}

bool LeftOutCells::make_lacking() {
    if (!left_out_) return false;
    std::uint32_t cells = 0;
    std::memcpy(&cells, counts_.mapped().data() + tile_dispatch(TileCells::kSegmented) + kCellsOfDispatch,
                sizeof cells);
    if (cells == 0) return false;
    const auto programs = segment_programs(variant_);
    programs_.make_together(settings_, programs);
    for (const SplatPrograms::Program& program : programs)
        programs_.wait_for(settings_, program);
    return true;
}

}  // namespace splice
