// What the passes of the tile backend hand to each other. The screen is cut into tiles of TILE pixels; every splat is
// recorded once, and listed once for every tile that its bounds touch. Needs frame.glsl, splat.glsl.
//
// The lists are ordered by record whatever the device does: the records are cut into chunks, a chunk is counted and
// listed by one invocation in order, and the lists' places are a prefix sum over (tile, chunk).
#ifndef SPLICE_TILE_GLSL
#define SPLICE_TILE_GLSL

// engine/passes/tile_buffers.h
const uvec2 TILE = uvec2(8, 4);  // pixels; a row is a vector of a CPU's device

layout(set = 2, binding = 0, std140) uniform TileUniforms {
    uint tiles_x, tiles_y;
    uint splats;    // records, culled ones included
    uint chunks;    // of records
    uint capacity;  // entries of the lists
} tiles;

struct TileSplat {
    uvec4 words[6];  // tile_record.glsl
};
layout(set = 2, binding = 1, std430) buffer SplatRecords { TileSplat records[]; };
// Tiles touched: minimum and, beyond it, maximum x (16 bits each), then y; 0 where nothing is.
layout(set = 2, binding = 2, std430) buffer SplatBounds { uvec2 splat_tiles[]; };
// [tile][chunk]: entries; then where the chunk's next entry goes, from the tile's start.
layout(set = 2, binding = 3, std430) buffer TileCounts { uint counts[]; };
// Where a tile's list begins; one more than there are tiles.
layout(set = 2, binding = 4, std430) buffer TileStarts { uint starts[]; };
layout(set = 2, binding = 5, std430) buffer TileLists { uint list[]; };

uint tile_count() { return tiles.tiles_x * tiles.tiles_y; }

uvec2 chunk_range(uint chunk) {
    const uint size = (tiles.splats + tiles.chunks - 1) / tiles.chunks;
    return min(uvec2(chunk, chunk + 1) * size, uvec2(tiles.splats));
}

#endif
