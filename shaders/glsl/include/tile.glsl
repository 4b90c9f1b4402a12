// What compute passes over splats hand to each other. The screen is cut into cells, and those into tiles of TILE
// pixels. Setup records the splats of GROUP surfels at a time, without gaps, in blocks of BLOCK, and sets the group's
// bit in the mask of every cell that one of its blocks touches; gathering walks the bits of its tile's cell, picks the
// blocks that touch the tile, and of those the splats.
//
// Of groups that are not for tiles, block bounds say which blocks have splats; the list has them in order.
//
// Bits have no order to get wrong and every group has its own place, so the result is the same whatever the device does
// first. There is no list that could be too short. Some drivers (llvmpipe) end every loop of an invocation once all its
// loops have run 65,535 times, so no invocation may run more often: a tile whose cell holds more than FUSED_GROUPS is
// gathered in segments. Texel buffers, not storage buffers, because software devices read those lane by lane.
//
// Such devices also run both sides of a branch, and the body of a loop at least once, whether an invocation is there or
// not. So cells without splats are not dispatched at all.
// Needs frame.glsl.
#ifndef SPLICE_TILE_GLSL
#define SPLICE_TILE_GLSL

// engine/passes/splat_buffers.h
const uvec2 TILE = uvec2(8, 4);  // pixels; a row is a vector of a CPU's device
const uint GROUP = 64;           // surfels
const uint BLOCK = 8;            // splats
const uint RECORD_TEXELS = 4;    // splat_record.glsl; solids have one more
const uint SEGMENT_WORDS = 8;    // of a cell's mask
// Groups of a cell that is gathered at once: finding the blocks of a group, and listing and then seeing, painting and
// painting what lacks of each of its splats, takes up to 1 + 3 (2 + 8 + 1/4) BLOCKS rounds of loops, some 247; of less
// than 65,535.
const uint FUSED_GROUPS = 264;
const uint BLOCKS = GROUP / BLOCK;
// Splats that a tile lists at once. With 4 bytes a block of its groups they are the 16 KiB that any device shares.
const uint MOST_LISTED = 992;

layout(set = 2, binding = 0, std140) uniform TileUniforms {
    uint cells_x, cells_y;
    uint cell_shift;  // a cell is 1 << cell_shift pixels wide and high
    uint words;       // of a cell's mask, 32 groups each
    uint segmented;   // 1: no cell is gathered at once
    uint first_solid;  // texel of the records
    uint first_listed; // texel of the list
}
tiles;

layout(set = 2, binding = 3, std430) buffer TileMasks {
    uint masks[];
};  // [cell][word]
layout(set = 2, binding = 5, std430) buffer TileCells {
    uvec4 dispatch[3];  // workgroups: tiles of a cell, cells, 1; by CELLS_*
    uint cells[];  // groups of each, with marks; then, as many again for each of CELLS_*, where they are (x, y: 16 bits
                   // each)
};
// Lists of cells: gathered at once, those with solids that are close to the eye, and all others; in segments. Each is a
// pipeline, which takes a while to make.
const uint CELLS_OTHERS = 0;
const uint CELLS_CLOSE = 1;
const uint CELLS_SEGMENTED = 2;
const uint CELL_HAS_CLOSE = 1 << 31;
uint groups_of_cell(uint cell) { return cells[cell] & ~CELL_HAS_CLOSE; }

// Splats to be rasterised, in the order of their surfels.
layout(set = 2, binding = 8, std430) buffer SplatList {
    uvec4 draw;    // vertices, instances, the first of each
    uint first[];  // of each group: how many it has, then where they begin; behind that, at tiles.first_listed - 4,
                   // places
}
list;

// What each workgroup of setup works on: the first surfel, and how many, with GROUP_SHOWS.
const uint GROUP_SHOWS = 1 << 31;  // kGroupShows
layout(set = 2, binding = 10, std430) readonly buffer GroupSources {
    uvec2 group_sources[];
};

// Of the workgroup with this number of `count`. Software devices give each of their threads a run of workgroups:
// neighbours, which hold about as much, go to different threads.
uint turn_of(uint number, uint count) {
    const uint half_way = (count + 1) / 2;
    return number < half_way ? 2 * number : 2 * (number - half_way) + 1;
}

uint cell_count() {
    return tiles.cells_x * tiles.cells_y;
}

// Blocks: minimum and, beyond it, maximum x (16 bits each), then y, in pixels; BLOCK_SOLID in the minimum x, where one
// of its splats is a solid.
const uint BLOCK_SOLID = 0x8000;

// Whether a block has a splat.
bool block_reaches(uvec2 bounds) { return (bounds.x & 0x7fff) < bounds.x >> 16; }

#endif
