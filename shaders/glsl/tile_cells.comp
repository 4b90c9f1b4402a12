// Tile backend: sorts the cells into those gathered at once and those gathered in segments. Their order does not
// matter: cells have no pixel in common.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "frame.glsl"
#include "tile.glsl"

layout(local_size_x = 64) in;

void main() {
    const uint cell = gl_GlobalInvocationID.x, count = cell_count();
    if (cell >= count) return;
    const uint place = cell % tiles.cells_x | cell / tiles.cells_x << 16;
    if (tiles.segmented == 0 && cells[cell] <= FUSED_GROUPS) {
        cells[count + atomicAdd(fused_dispatch.y, 1)] = place;
    } else {
        cells[2 * count - 1 - atomicAdd(segmented_dispatch.y, 1)] = place;
    }
}
