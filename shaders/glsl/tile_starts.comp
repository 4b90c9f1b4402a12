// Tile backend: from the lengths of the tiles' lists to where they begin. One workgroup.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "tile.glsl"

layout(local_size_x = 64) in;

layout(set = 2, binding = 8, std430) buffer TileReport { uint entries_needed; };

shared uint sums[gl_WorkGroupSize.x];

// Large splats in many tiles make more entries than 32 bits count: the sum then stays at the most, which no list has
// room for.
uint add_up(uint a, uint b) {
    uint carry;
    const uint sum = uaddCarry(a, b, carry);
    return carry != 0 ? 0xffffffffu : sum;
}

void main() {
    const uint lane = gl_LocalInvocationID.x;
    const uint size = (tile_count() + gl_WorkGroupSize.x - 1) / gl_WorkGroupSize.x;
    const uint first = min(lane * size, tile_count()), end = min(first + size, tile_count());
    uint sum = 0;
    for (uint tile = first; tile < end; ++tile) sum = add_up(sum, starts[tile]);
    sums[lane] = sum;
    barrier();
    uint before = 0;
    for (uint i = 0; i < lane; ++i) before = add_up(before, sums[i]);
    for (uint tile = first; tile < end; ++tile) {
        const uint entries = starts[tile];
        starts[tile] = before;
        before = add_up(before, entries);
    }
    if (lane == gl_WorkGroupSize.x - 1) {
        starts[tile_count()] = before;
        entries_needed = before;
    }
}
