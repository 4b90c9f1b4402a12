// Tile backend: visibility and attributes of a tile's pixels, gathered from the blocks that touch it: what
// surfel_visibility.frag and surfel_attribute.frag compute (thesis 3.4.2), with the loops turned inside out. An
// invocation has a column of the tile. The splats that touch the tile are listed first, two of a block of eight where
// they are small. They are read as many at once as there are invocations, one each, and brought into the tile's
// coordinates; then they are handed round one by one. All that a pixel needs of a splat is affine in the pixel
// (splat.glsl): rows are reached by addition.
//
// Loops test at their end: a device that runs invocations in lockstep and masks those that have left a loop would run
// the body once more for nobody.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#extension GL_KHR_shader_subgroup_arithmetic : require
#extension GL_KHR_shader_subgroup_basic : require
#extension GL_KHR_shader_subgroup_ballot : require
#extension GL_KHR_shader_subgroup_shuffle : require
#extension GL_KHR_shader_subgroup_vote : require
#include "frame.glsl"
#include "octahedral.glsl"
#include "colour.glsl"
#include "lighting.glsl"
#include "splat.glsl"
#include "surfel_record.glsl"
#include "surfel_frame.glsl"
#include "tile.glsl"
#include "splat_record.glsl"
#include "tile_plane.glsl"
#include "tile_solid.glsl"
#include "compose.glsl"
#include "splat_targets.glsl"

layout(local_size_x = 8) in;

// What is done: all of a cell's tiles at once, or the visibility or the attributes of one segment of their groups.
layout(constant_id = 0) const uint PART = 0;
const uint PART_ALL = 0;
const uint PART_VISIBILITY = 1;
const uint PART_ATTRIBUTES = 2;

// Which of CELLS_* the cell is of.
layout(constant_id = 7) const uint CELLS = CELLS_OTHERS;

// Whether other backends draw splats of the same frame: visibility begins with what they found visible, and when it
// comes to attributes, the frame's depth is that of all.
layout(constant_id = 4) const bool MIXED = false;

// Whether tiles become the picture, which has the triangles already; else sums, for the normalise pass.
layout(constant_id = 3) const bool COMPOSE = false;

layout(set = 2, binding = 4) uniform usamplerBuffer record_texels;
layout(set = 2, binding = 6) uniform usamplerBuffer block_texels;
layout(set = 2, binding = 7) uniform usamplerBuffer mask_texels;
const uint MOST_GROUPS = max(FUSED_GROUPS, 32 * SEGMENT_WORDS);
// Blocks that touch the tile: those of flat splats from the front, the others from the back.
shared uint touching[MOST_GROUPS * BLOCKS];
const uint LAST_TOUCHING = MOST_GROUPS * BLOCKS - 1;
// Numbers of splats that touch the tile: flat ones, then the others.
shared uint listed[2 * MOST_LISTED];

struct Found {
    uint flat_blocks, solid_blocks;
};

Found find_blocks(uint cell, uint first_word, uint end_word, uvec2 corner) {
    const uint lane = gl_LocalInvocationID.x;
    Found found = Found(0, 0);
    uint word = first_word;
    do {
        const uint own = word + lane;
        const uint bits_of_own = own < end_word ? texelFetch(mask_texels, int(cell * tiles.words + own)).x : 0;
        uint words_left = subgroupBallot(bits_of_own != 0).x;
        if (words_left != 0) do {
                const uint in_batch = findLSB(words_left);
                words_left &= words_left - 1;
                uint bits = subgroupShuffle(bits_of_own, in_batch);
                const uint first_block = (word + in_batch) * 32 * BLOCKS + lane;
                do {
                    const uint block = first_block + findLSB(bits) * BLOCKS;
                    bits &= bits - 1;
                    const uvec2 bounds = texelFetch(block_texels, int(block)).xy;
                    const uvec2 low = bounds & uvec2(0x7fff, 0xffff), high = bounds >> 16;
                    const bool touches = all(lessThan(low, corner + TILE)) && all(greaterThan(high, corner));
                    const bool solid = (bounds.x & BLOCK_SOLID) != 0;
                    const uvec4 flat_touching = subgroupBallot(touches && !solid);
                    const uvec4 solid_touching = subgroupBallot(touches && solid);
                    const uint place =
                        solid ? LAST_TOUCHING - found.solid_blocks - subgroupBallotExclusiveBitCount(solid_touching)
                              : found.flat_blocks + subgroupBallotExclusiveBitCount(flat_touching);
                    if (touches) touching[place] = block;
                    found.solid_blocks += subgroupBallotBitCount(solid_touching);
                    found.flat_blocks += subgroupBallotBitCount(flat_touching);
                } while (bits != 0);
            } while (words_left != 0);
        word += gl_WorkGroupSize.x;
    } while (word < end_word);
    subgroupMemoryBarrierShared();
    subgroupBarrier();
    return found;
}

struct Tile {
    uvec2 corner;
    float along_axis[TILE.y];  // depth gained a unit of a pixel's ray
    float triangles[TILE.y];   // depth buffer values
    float visible[TILE.y];
    vec4 sum[TILE.y];
    vec4 normal_sum[TILE.y];  // deferred: as FrameTargets::normals
    bool owned[TILE.y];
    bool lacks[TILE.y];  // owned, but next to nothing was painted
    float farthest;  // of what surfels own; beyond 1: nothing
};

vec2 first_pixel(Tile tile) {
    return vec2(tile.corner) + 0.5;
}
vec2 centre_of(Tile tile) {
    return vec2(tile.corner) + 0.5 * vec2(TILE);
}

// What is met of a splat: a flat disk; a solid; the same, close to the eye; what a line leaves of a solid's disk. Cells
// where something is close have all of their solids met that way.
const int FLAT = 0, SOLID = 1, CLOSE_SOLID = 2, CUT_DISK = 3;
const int SOLIDS = CELLS == CELLS_CLOSE || CELLS == CELLS_SEGMENTED ? CLOSE_SOLID : SOLID;

// One an invocation.
struct TileSplat {
    SplatPlace place;
    SplatPlane splat;
    TilePlane plane;
    TileSolid solid;
    TileAxis axis;
    vec3 past_clip;
    bool speck;
    uint number;
};

TileSplat read_splat(uint number, const int kind, Tile tile) {
    TileSplat mine;
    mine.number = number;
    const int texel = int(mine.number * RECORD_TEXELS), solid_texel = int(tiles.first_solid + 2 * mine.number);
    mine.place = unpack_place(texelFetch(record_texels, texel));
    mine.splat = unpack_plane(texelFetch(record_texels, texel + 1), texelFetch(record_texels, texel + 2));
    mine.plane = plane_in_tile(mine.place.z, mine.splat, first_pixel(tile) - mine.place.anchor);
    mine.speck = (mine.splat.marks & MARK_SPECK) != 0;
    if (mine.speck) mine.plane = speck_in_tile(mine.place, first_pixel(tile));
    if (kind == FLAT) return mine;
    const uvec4 last = texelFetch(record_texels, solid_texel + 1);
    if (kind == CUT_DISK) {
        mine.past_clip = past_clip_in_tile(unpack_clip(last, mine.splat.marks), mine.plane);
        return mine;
    }
    const SplatSolid solid = unpack_solid(texelFetch(record_texels, solid_texel), last, mine.splat.marks);
    mine.plane.u += solid.plane_offset.x * mine.plane.e;
    mine.plane.v += solid.plane_offset.y * mine.plane.e;
    mine.solid = solid_in_tile(solid);
    if (kind == SOLID) mine.axis = axis_in_tile(mine.solid, mine.place.z);
    mine.past_clip = past_clip_in_tile(solid.clip, mine.plane);
    return mine;
}

// The splat of another invocation, as its pixels meet it.
struct MetSplat {
    TilePlane plane;
    TileSolid solid;
    TileAxis axis;
    vec3 past_clip;
};

MetSplat hand_round(TileSplat mine, const int kind, uint i) {
    MetSplat met;
    met.plane = hand_round(mine.plane, i);
    if (kind != FLAT) met.past_clip = subgroupShuffle(mine.past_clip, i);
    if (kind == SOLID) met.axis = hand_round(mine.axis, i);
    if (kind == CLOSE_SOLID) met.solid = hand_round(mine.solid, i);
    return met;
}

// What a pixel's ray meets of it; `past_clip` is that of the pixel.
Meeting meet(PixelPlane at, const int kind, MetSplat splat, float past_clip) {
    if (kind == CLOSE_SOLID) return meet_close_solid(at, splat.solid, past_clip);
    if (kind == SOLID) return meet_solid(at, splat.axis, past_clip);
    Meeting meeting = meet_disk(at);
    if (kind == CUT_DISK) meeting.on_disk = meeting.on_disk && past_clip <= 0;
    return meeting;
}

// Splats that touch the tile, of one list of blocks. They are in order, and where there is no room for all of them,
// they come one run of blocks after the other.
struct TileList {
    uint blocks;
    uint begin, end;  // of the blocks whose splats are listed
    uint count;       // of splats
};

uint place_in_list(const int kind, uint n) {
    return kind == FLAT ? n : MOST_LISTED + n;
}

// Lists what comes next; after the last run the first. What is whole stays.
void list_next(const int kind, inout TileList list, Tile tile) {
    const uint lane = gl_LocalInvocationID.x;
    const bool whole = list.begin == 0 && list.end == list.blocks;
    list.begin = list.end < list.blocks ? list.end : 0;
    list.count = whole ? list.count : 0;
    uint n = whole ? list.blocks : list.begin;
    subgroupBarrier();
    do {
        // Every invocation reads a block's number.
        const uint own = min(n + lane, list.blocks - 1);
        const uint block_of_own = touching[kind == FLAT ? own : LAST_TOUCHING - own];
        const uint end = min(list.blocks - n, gl_WorkGroupSize.x);
        uint i = 0;
        do {
            const uint number = subgroupShuffle(block_of_own, i) * BLOCK + lane;
            const SplatPlace place = unpack_place(texelFetch(record_texels, int(number * RECORD_TEXELS)));
            const bool touches = i < end && touches_tile(place, centre_of(tile));
            const uvec4 all = subgroupBallot(touches);
            if (touches) listed[place_in_list(kind, list.count + subgroupBallotExclusiveBitCount(all))] = number;
            list.count += subgroupBallotBitCount(all);
        } while (++i < end);
        n = min(n + gl_WorkGroupSize.x, list.blocks);
    } while (n < list.blocks && list.count + gl_WorkGroupSize.x * BLOCK <= MOST_LISTED);
    list.end = n;
    subgroupMemoryBarrierShared();
    subgroupBarrier();
}

void see_splats(uint first, uint count, const int kind, inout Tile tile) {
    const float column = float(gl_LocalInvocationID.x);
    const uint own = first + gl_LocalInvocationID.x;
    const TileSplat mine = read_splat(listed[place_in_list(kind, min(own, count - 1))], kind, tile);
    uint left = subgroupBallot(own < count).x;
    if (left != 0) do {
            const uint i = findLSB(left);
            left &= left - 1;
            const MetSplat splat = hand_round(mine, kind, i);
            const float push = subgroupShuffle(mine.splat.push, i);
            PixelPlane at = at_column(splat.plane, column);
            float past_clip = kind == FLAT ? 0 : splat.past_clip.x + splat.past_clip.y * column;
            [[unroll]] for (int row = 0; row < TILE.y; ++row) {
                const Meeting meeting = meet(at, kind, splat, past_clip);
                const float away = push * tile.along_axis[row] * (meeting.beside_disk ? BESIDE_PUSH : 1);
                const float back = pushed(meeting.z, meeting.share, away);
                const bool met = meeting.on_disk || meeting.beside_disk;
                tile.visible[row] = met ? larger(tile.visible[row], back) : tile.visible[row];
                at = next_row(at, splat.plane);
                if (kind != FLAT) past_clip += splat.past_clip.z;
            }
        } while (left != 0);
}

// The default kernel is exp(-x) for x in [0, 1], to 1e-5: Chebyshev interpolation.
float falloff(float x) {
    if (KERNEL != KERNEL_DISK) return other_kernel(min(x, KERNEL_SUPPORT2));
    return 0.99998916 + x * (-0.99945630 + x * (0.49556967 + x * (-0.15375046 + x * 0.025536540)));
}

void add_part(float part, float weight, float z, vec3 colour, vec3 albedo, int row, inout Tile tile) {
    if (VIEW == VIEW_OVERLAP) {
        tile.sum[row].a += part;
        return;
    }
    if (DEFERRED) {
        tile.sum[row].rgb += part * albedo;
        tile.normal_sum[row] += part * vec4(colour, weight * z);
    } else if (VIEW == VIEW_DEPTH) {
        tile.sum[row].rgb += part * weight * decode_depth(max(z, 1e-30));
    } else {
        tile.sum[row].rgb += part * larger(colour, vec3(0));
    }
    tile.sum[row].a += part * weight;
}

// `lacking`: where next to nothing was painted, what is met beside disks.
void paint_splats(uint first, uint count, const int kind, const bool lacking, inout Tile tile) {
    const float column = float(gl_LocalInvocationID.x);
    const uint own = first + gl_LocalInvocationID.x;
    TileSplat mine = read_splat(listed[place_in_list(kind, min(own, count - 1))], kind, tile);
    // A filtered speck reaches its pixel anyway, and weighs there what its footprint does.
    if (mine.speck && frame.prefilter != 0) mine.plane.u = vec3(2, 0, 0);
    const int texel = int(mine.number * RECORD_TEXELS);
    const SplatPaint paint = unpack_paint(mine.splat, texelFetch(record_texels, texel + 3));
    const SplatFilter filtered = filter_of(mine.splat);
    // Beyond the disk its plane may be anywhere; a speck's is its centre's.
    const float z = mine.place.z, rise = mine.speck ? 0 : mine.splat.rise;
    const float nearest_z = ORTHOGRAPHIC ? z + rise : (rise < 1 ? z / (1 - rise) : 1e30);
    const float farthest_z = ORTHOGRAPHIC ? z - rise : z / (1 + rise);
    const float my_weight = VIEW == VIEW_OVERLAP ? 1 : filtered.weight;
    const vec3 my_colour = paint.colour * my_weight;
    const vec3 my_albedo =
        DEFERRED ? unpack_albedo(texelFetch(record_texels, int(tiles.first_solid + 2 * mine.number) + 1)) * my_weight
                 : vec3(0);
    const float bend = mine.speck ? 0 : my_weight;
    // Colours change along the disk, e times as fast.
    const vec3 bend_u = paint.colour_u * bend, bend_v = paint.colour_v * bend;
    const vec3 my_bend = bend_u * mine.plane.u.x + bend_v * mine.plane.v.x;
    const vec3 bend_column = bend_u * mine.plane.u.y + bend_v * mine.plane.v.y;
    const vec3 bend_row = bend_u * mine.plane.u.z + bend_v * mine.plane.v.z;
    // The ellipse, x^T V^-1 x / 2, as a polynomial of the column and of the row.
    const vec2 d = first_pixel(tile) - mine.place.anchor;
    const vec3 conic = filtered.conic * (KERNEL_MOMENT * vec3(1, 2, 1));
    const vec3 ellipse_column = vec3(conic.x * d.x * d.x + conic.y * d.x * d.y + conic.z * d.y * d.y,
                                     2 * conic.x * d.x + conic.y * d.y, conic.x);
    const vec3 ellipse_row = vec3(2 * conic.z * d.y + conic.y * d.x, conic.y, conic.z);
    const float my_half_pixel = kind == FLAT ? 0 : 0.5 * length(mine.past_clip.yz);

    uint left = subgroupBallot(own < count && nearest_z >= tile.farthest).x;
    if (left != 0) do {
            const uint i = findLSB(left);
            left &= left - 1;
            const MetSplat splat = hand_round(mine, kind, i);
            const vec2 z_ends = subgroupShuffle(vec2(farthest_z, nearest_z), i);
            const vec3 by_column = subgroupShuffle(ellipse_column, i), by_row = subgroupShuffle(ellipse_row, i);
            float ellipse = by_column.x + column * (by_column.y + column * by_column.z);
            float slope = by_row.x + column * by_row.y + by_row.z;
            const float weight = subgroupShuffle(my_weight, i);
            const vec3 colour = subgroupShuffle(my_colour, i);
            const vec3 albedo = DEFERRED ? subgroupShuffle(my_albedo, i) : vec3(0);
            // Of disks alone the colour is affine, too.
            const bool affine = kind == FLAT || kind == CUT_DISK;
            vec3 bent, bent_step, cu, cv;
            if (affine) {
                bent = subgroupShuffle(my_bend, i) + column * subgroupShuffle(bend_column, i);
                bent_step = subgroupShuffle(bend_row, i);
            } else {
                cu = subgroupShuffle(bend_u, i);
                cv = subgroupShuffle(bend_v, i);
            }
            PixelPlane at = at_column(splat.plane, column);
            float past_clip = kind == FLAT ? 0 : splat.past_clip.x + splat.past_clip.y * column;
            const float half_pixel = kind == FLAT ? 0 : subgroupShuffle(my_half_pixel, i);
            [[unroll]] for (int row = 0; row < TILE.y; ++row) {
                const Meeting meeting = meet(at, kind, splat, past_clip);
                const bool on_disk = meeting.on_disk && at.e > 0;
                const bool kept = kind == FLAT || (at.e < 0 ? -past_clip : past_clip) <= half_pixel;
                const bool in_footprint = ellipse < KERNEL_SUPPORT2 && kept;
                float met_z = meeting.z / meeting.share;
                vec2 nearest = meeting.nearest;
                if (kind == CLOSE_SOLID && in_footprint && meeting.beside_disk) {
                    met_z = larger(met_z, ORTHOGRAPHIC ? at.z : at.z * at.e);
                    nearest = vec2(at.u, at.v);
                }
                // Beyond the disk, the colour at its border; beyond the plane's horizon, that of its centre.
                const float across = affine ? meeting.distance2 : dot(nearest, nearest);
                const float scale = at.e > 0 ? inversesqrt(larger(across, at.e * at.e)) : 0;
                if (!affine) bent = cu * nearest.x + cv * nearest.y;
                // The polynomial may fall below 0 by rounding.
                const float exponent =
                    larger(smaller(on_disk ? meeting.distance2 * scale * scale : KERNEL_SUPPORT2, ellipse), 0);
                const float z = smaller(larger(met_z, z_ends.x), z_ends.y);
                bool reached = lacking ? meeting.beside_disk && tile.lacks[row]
                                       : on_disk || meeting.beside_disk || in_footprint;
                reached = reached && z >= tile.visible[row];
                const float share = VIEW == VIEW_OVERLAP                          ? 1
                                    : meeting.beside_disk && (lacking || !in_footprint) ? BESIDE_WEIGHT
                                                                                        : falloff(exponent);
                add_part(reached ? share : 0, weight, z, colour + bent * scale, albedo, row, tile);
                at = next_row(at, splat.plane);
                if (affine) bent += bent_step;
                if (kind != FLAT) past_clip += splat.past_clip.z;
                ellipse += slope;
                slope += 2 * by_row.z;
            }
        } while (left != 0);
}

void see(const int kind, inout TileList list, inout Tile tile) {
    if (list.blocks == 0) return;
    do {
        list_next(kind, list, tile);
        uint n = 0;
        if (list.count != 0) do {
                see_splats(n, list.count, kind, tile);
                n += gl_WorkGroupSize.x;
            } while (n < list.count);
    } while (list.end < list.blocks);
}

void own(inout Tile tile) {
    tile.farthest = 2;
    [[unroll]] for (int row = 0; row < TILE.y; ++row) {
        tile.owned[row] = tile.visible[row] > tile.triangles[row];
        // What defined the depth passes the test against it, rounded or not.
        tile.visible[row] -= tile.visible[row] * 2.5e-7;
        tile.farthest = tile.owned[row] ? min(tile.farthest, tile.visible[row]) : tile.farthest;
    }
    tile.farthest = subgroupMin(tile.farthest);
}

void paint(const int kind, const bool lacking, inout TileList list, inout Tile tile) {
    if (list.blocks == 0 || tile.farthest > 1) return;
    do {
        list_next(kind, list, tile);
        uint n = 0;
        if (list.count != 0) do {
                paint_splats(n, list.count, kind, lacking, tile);
                n += gl_WorkGroupSize.x;
            } while (n < list.count);
    } while (list.end < list.blocks);
}

// Of solids mostly the disks show: what is met beside them weighs so little that it is looked for only where all else
// does, too. Elsewhere each of them would change less than a hundredth of the colour.
const float ENOUGH_WEIGHT = 100 * BESIDE_WEIGHT;
const bool PAINT_DISKS_FIRST = SOLIDS == SOLID && VIEW != VIEW_OVERLAP;

void paint_solids(inout TileList list, inout Tile tile) {
    if (!PAINT_DISKS_FIRST) {
        paint(CLOSE_SOLID, false, list, tile);
        return;
    }
    paint(CUT_DISK, false, list, tile);
    bool lacks = false;
    [[unroll]] for (int row = 0; row < TILE.y; ++row) {
        tile.lacks[row] = tile.owned[row] && tile.sum[row].a < ENOUGH_WEIGHT;
        lacks = lacks || tile.lacks[row];
    }
    if (subgroupAny(lacks)) paint(SOLID, true, list, tile);
}

void main() {
    const uint place = cells[(1 + CELLS) * cell_count() + turn_of(gl_WorkGroupID.y, gl_NumWorkGroups.y)];
    const uint across_shift = tiles.cell_shift - findMSB(TILE.x);
    Tile tile;
    tile.corner = (uvec2(place & 0xffff, place >> 16) << tiles.cell_shift) +
                  uvec2(gl_WorkGroupID.x & ((1 << across_shift) - 1), gl_WorkGroupID.x >> across_shift) * TILE;
    const ivec2 first = ivec2(tile.corner) + ivec2(gl_LocalInvocationID.x, 0);
    const bool starts = (instance.flags & INSTANCE_FIRST_SEGMENT) != 0;
    [[unroll]] for (int row = 0; row < TILE.y; ++row) {
        // Beyond the picture's edge any depth will do: what is stored there is dropped.
        const ivec2 pixel = min(first + ivec2(0, row), ivec2(frame.viewport) - 1);
        tile.triangles[row] = texelFetch(scene_depth, pixel, 0).r;
        tile.visible[row] = tile.triangles[row];
        tile.sum[row] = vec4(0);
        tile.normal_sum[row] = vec4(0);
        if (PART != PART_ALL) {
            if (MIXED ? PART == PART_VISIBILITY : PART == PART_ATTRIBUTES || !starts)
                tile.visible[row] = max(tile.visible[row], uintBitsToFloat(imageLoad(splat_depth, pixel).r));
            if (PART == PART_ATTRIBUTES && !starts) tile.sum[row] = imageLoad(accumulation, pixel);
            if (DEFERRED && PART == PART_ATTRIBUTES && !starts) tile.normal_sum[row] = imageLoad(normals, pixel);
            if (MIXED && PART == PART_ATTRIBUTES) tile.triangles[row] = -1;  // who owns a pixel the stencil says
        }
        const vec2 off = (vec2(pixel) + 0.5 - frame.viewport * 0.5) / frame.pixel_scale;
        tile.along_axis[row] = ORTHOGRAPHIC ? 1 : inversesqrt(1 + dot(off, off));
    }
    const uint cell = (place >> 16) * tiles.cells_x + (place & 0xffff);
    const uint first_word = PART == PART_ALL ? 0 : instance.first_word;
    const uint last_word = PART == PART_ALL ? tiles.words : min(first_word + SEGMENT_WORDS, tiles.words);
    const uint end_word = groups_of_cell(cell) == 0 ? first_word : last_word;
    const Found found = find_blocks(cell, first_word, end_word, tile.corner);
    TileList flat_splats = TileList(found.flat_blocks, 0, 0, 0), solids = TileList(found.solid_blocks, 0, 0, 0);
    if (PART != PART_ATTRIBUTES) {
        see(FLAT, flat_splats, tile);
        see(SOLIDS, solids, tile);
    }
    if (PART != PART_VISIBILITY) {
        own(tile);
        paint(FLAT, false, flat_splats, tile);
        paint_solids(solids, tile);
    }
    const bool ends = PART == PART_ALL || (instance.flags & INSTANCE_LAST_SEGMENT) != 0;
    [[unroll]] for (int row = 0; row < TILE.y; ++row) {
        const ivec2 pixel = first + ivec2(0, row);
        if (PART == PART_VISIBILITY) {
            imageStore(splat_depth, pixel, uvec4(floatBitsToUint(tile.visible[row])));
        } else if (PART == PART_ATTRIBUTES || !COMPOSE) {
            imageStore(accumulation, pixel, tile.owned[row] ? tile.sum[row] : vec4(0));
            if (DEFERRED) imageStore(normals, pixel, tile.normal_sum[row]);
        }
        if (COMPOSE && PART != PART_VISIBILITY && ends && tile.owned[row] && tile.sum[row].a > 0)
            imageStore(picture, pixel, composed(vec4(0), true, tile.sum[row], false));
    }
}
