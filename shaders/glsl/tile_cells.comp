// Tile backend: sorts the cells that hold splats into lists. Their order does not matter: cells have no pixel in
// common.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "frame.glsl"
#include "tile.glsl"

layout(local_size_x = 64) in;

void main() {
    const uint cell = gl_GlobalInvocationID.x, count = cell_count();
    if (cell >= count) return;
    const uint place = cell % tiles.cells_x | cell / tiles.cells_x << 16;
    const uint marks = cells[cell];
    // In a frame of several batches a cell may have had splats before, or may have some yet.
    if (marks == 0 && tiles.segmented == 0) return;
    uint kind = CELLS_SEGMENTED;
    if (tiles.segmented == 0 && groups_of_cell(cell) <= FUSED_GROUPS)
        kind = (marks & CELL_HAS_CLOSE) != 0 ? CELLS_CLOSE : CELLS_OTHERS;
    cells[(1 + kind) * count + atomicAdd(dispatch[kind].y, 1)] = place;
}
