// Tile backend: from the entries of each chunk to their places in the list of their tile, tile by tile.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "tile.glsl"

layout(local_size_x = 64) in;

void main() {
    const uint tile = gl_GlobalInvocationID.x;
    if (tile >= tile_count()) return;
    uint before = 0;
    for (uint i = tile * tiles.chunks; i < (tile + 1) * tiles.chunks; ++i) {
        const uint entries = counts[i];
        counts[i] = before;
        before += entries;
    }
    starts[tile] = before;
}
