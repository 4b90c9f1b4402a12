// Tile backend: how many splats of each chunk touch each tile.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "tile.glsl"

layout(local_size_x = 8) in;

void main() {
    const uint chunk = gl_GlobalInvocationID.x;
    if (chunk >= tiles.chunks) return;
    const uvec2 range = chunk_range(chunk);
    for (uint i = range.x; i < range.y; ++i) {
        const uvec2 touched = splat_tiles[i];
        for (uint y = touched.y & 0xffff; y < touched.y >> 16; ++y)
            for (uint x = touched.x & 0xffff; x < touched.x >> 16; ++x)
                ++counts[(y * tiles.tiles_x + x) * tiles.chunks + chunk];
    }
}
