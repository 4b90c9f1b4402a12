// Tile backend: visibility and attributes of a tile's pixels, gathered from the blocks that touch it: what
// surfel_visibility.frag and surfel_attribute.frag compute (thesis 3.4.2), with the loops turned inside out. An
// invocation has a column of the tile. Splats are read as many at once as there are invocations, one each, and brought
// into the tile's coordinates; then those that touch the tile are handed round one by one. All that a pixel needs of a
// splat is affine in the pixel (splat.glsl): rows are reached by addition.
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
#include "frame.glsl"
#include "octahedral.glsl"
#include "colour.glsl"
#include "lighting.glsl"
#include "splat.glsl"
#include "surfel_record.glsl"
#include "surfel_frame.glsl"
#include "tile.glsl"
#include "splat_record.glsl"
#include "compose.glsl"
#include "splat_targets.glsl"

layout(local_size_x = 8) in;

// What is done: all of a cell's tiles at once, or the visibility or the attributes of one segment of their groups.
layout(constant_id = 0) const uint PART = 0;
const uint PART_ALL = 0;
const uint PART_VISIBILITY = 1;
const uint PART_ATTRIBUTES = 2;

// Which of CELLS_* the cell is of.
layout(constant_id = 7) const uint CELLS = CELLS_BOTH;

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
                // Of all blocks of the group alike.
                const bool solid = (bounds.x & BLOCK_SOLID) != 0;
                const uvec4 all_touching = subgroupBallot(touches);
                const uint before = subgroupBallotExclusiveBitCount(all_touching);
                if (touches)
                    touching[solid ? LAST_TOUCHING - found.solid_blocks - before : found.flat_blocks + before] = block;
                const uint count = subgroupBallotBitCount(all_touching);
                found.solid_blocks += solid ? count : 0;
                found.flat_blocks += solid ? 0 : count;
                } while (bits != 0);
            } while (words_left != 0);
        word += gl_WorkGroupSize.x;
    } while (word < end_word);
    subgroupMemoryBarrierShared();
    subgroupBarrier();
    return found;
}

bool touches_tile(SplatPlace place, vec2 tile_centre) {
    return all(lessThanEqual(abs(place.anchor - tile_centre), place.reach + 0.5 * vec2(TILE - 1)));
}

// Relative to the tile's first pixel: value there, change a column, change a row.
struct TilePlane {
    vec3 e, u, v;  // splat.glsl; orthographic: e is 1
    float z;       // orthographic: there, and z_step how it changes; perspective: of the anchor
    vec2 z_step;
};

TilePlane plane_in_tile(float z, SplatPlane splat, vec2 d) {
    TilePlane plane;
    const float gd = dot(splat.g, d);
    plane.e = ORTHOGRAPHIC ? vec3(1, 0, 0) : vec3(1 + gd, splat.g);
    plane.u = vec3(dot(splat.plane_map.xz, d), splat.plane_map.xz);
    plane.v = vec3(dot(splat.plane_map.yw, d), splat.plane_map.yw);
    plane.z = ORTHOGRAPHIC ? z + gd : z;
    plane.z_step = splat.g;
    return plane;
}

TilePlane hand_round(TilePlane mine, uint i) {
    TilePlane plane;
    plane.e = subgroupShuffle(mine.e, i);
    plane.u = subgroupShuffle(mine.u, i);
    plane.v = subgroupShuffle(mine.v, i);
    plane.z = subgroupShuffle(mine.z, i);
    plane.z_step = subgroupShuffle(mine.z_step, i);
    return plane;
}

// The values at a pixel.
struct PixelPlane {
    float e, u, v, z;
};

PixelPlane at_column(TilePlane plane, float column) {
    return PixelPlane(plane.e.x + plane.e.y * column, plane.u.x + plane.u.y * column, plane.v.x + plane.v.y * column,
                      plane.z + (ORTHOGRAPHIC ? plane.z_step.x * column : 0));
}

PixelPlane next_row(PixelPlane at, TilePlane plane) {
    return PixelPlane(at.e + plane.e.z, at.u + plane.u.z, at.v + plane.v.z, at.z + (ORTHOGRAPHIC ? plane.z_step.y : 0));
}

SplatSolid read_solid(uint place, uint marks) {
    const int texel = int(tiles.first_solid + 2 * place);
    return unpack_solid(texelFetch(record_texels, texel), texelFetch(record_texels, texel + 1).x, marks);
}

struct TileSolid {
    vec3 past_clip;     // as TilePlane
    float clip_change;  // perspective: less past_clip, over e
    vec2 skew;
    vec2 h;  // least and largest gain towards the axis
    float climb;
};

TileSolid solid_in_tile(SplatSolid solid, TilePlane plane, bool speck) {
    const vec2 ends = vec2(-solid.swell.y, solid.swell.x) * (ORTHOGRAPHIC ? 1 : solid.climb);
    // A speck shows at its own pixel and nowhere else.
    const vec2 h = speck ? vec2(0) : vec2(min(ends.x, ends.y), max(ends.x, ends.y));
    vec3 past_clip = solid.clip.x * plane.u + solid.clip.y * plane.v - solid.clip.z * plane.e;
    past_clip.x -= CLIP_SLACK * length(past_clip.yz);
    return TileSolid(past_clip,
                     dot(solid.clip.xy, solid.skew) + (ORTHOGRAPHIC ? 0 : solid.clip.z), solid.skew, h, solid.climb);
}

TileSolid hand_round(TileSolid mine, uint i) {
    return TileSolid(subgroupShuffle(mine.past_clip, i), subgroupShuffle(mine.clip_change, i), subgroupShuffle(mine.skew, i), subgroupShuffle(mine.h, i), subgroupShuffle(mine.climb, i));
}

// cast_ray of splat.glsl without specks. `z`: perspective: the depth buffer value times `share`.
struct Meeting {
    bool on_disk, beside_disk;
    float z, share;
    vec2 nearest;     // e times the disk's coordinates
    float distance2;  // of the plane's point, e^2 times the square
};

Meeting meet_disk(PixelPlane at) {
    const float distance2 = at.u * at.u + at.v * at.v;
    return Meeting(distance2 <= at.e * at.e, false, ORTHOGRAPHIC ? at.z : at.z * at.e, 1, vec2(at.u, at.v), distance2);
}

// `at_clip`: past_clip at the pixel.
Meeting meet_solid(PixelPlane at, TileSolid solid, float at_clip) {
    Meeting meeting = meet_disk(at);
    // Beyond the plane's horizon e is below 0.
    const float past_clip = at.e < 0 ? -at_clip : at_clip;
    meeting.on_disk = meeting.on_disk && at.e > 0 && past_clip <= 0 && meeting.z <= 1;
    const vec2 q = ORTHOGRAPHIC ? solid.skew : vec2(at.u + solid.skew.x * at.e, at.v + solid.skew.y * at.e);
    const float uq = at.u * q.x + at.v * q.y;
    const float qq = q.x * q.x + q.y * q.y;
    // The part of the solid in front of the near plane: z / (1 + gain) or z - gain climb is at most 1 there.
    const float near_gain = ORTHOGRAPHIC ? (meeting.z - 1) / solid.climb : meeting.z - 1;
    const bool grows = ORTHOGRAPHIC ? solid.climb > 0 : at.e > 0;
    float low = grows ? max(solid.h.x, near_gain) : solid.h.x;
    float high = grows ? solid.h.y : min(solid.h.y, near_gain);
    // And on the side of the clip line that is kept.
    const float clip_change = solid.clip_change * (ORTHOGRAPHIC ? 1 : abs(at.e)) + (ORTHOGRAPHIC ? 0 : past_clip);
    const float clip_gain = -past_clip / clip_change;
    high = clip_change > 0 ? min(high, clip_gain) : high;
    low = clip_change < 0 ? max(low, clip_gain) : low;
    high = clip_change == 0 && past_clip > 0 ? low - 1 : high;
    const float gain = clamp(-uq / max(qq, 1e-30), low, high);
    meeting.beside_disk =
        !meeting.on_disk && low <= high && meeting.distance2 + gain * (2 * uq + gain * qq) <= at.e * at.e;
    const float h = meeting.beside_disk ? gain : 0;
    meeting.share = ORTHOGRAPHIC ? 1 : 1 + h;
    meeting.z -= ORTHOGRAPHIC ? h * solid.climb : 0;
    meeting.nearest += h * q;
    return meeting;
}

// Where in the tile a speck shows even if the ray misses it; -1: nowhere.
int speck_pixel_of(bool speck, vec2 anchor, uvec2 corner) {
    const ivec2 pixel = ivec2(floor(anchor)) - ivec2(corner);
    const bool shows = speck && all(greaterThanEqual(pixel, ivec2(0))) && all(lessThan(pixel, ivec2(TILE)));
    return shows ? pixel.x + pixel.y * int(TILE.x) : -1;
}

struct Tile {
    uvec2 corner;
    float along_axis[TILE.y];  // depth gained a unit of a pixel's ray
    float triangles[TILE.y];   // depth buffer values
    float visible[TILE.y];
    vec4 sum[TILE.y];
    vec4 normal_sum[TILE.y];  // deferred: as FrameTargets::normals
    bool owned[TILE.y];
    float farthest;  // of what surfels own; beyond 1: nothing
};

vec2 first_pixel(Tile tile) {
    return vec2(tile.corner) + 0.5;
}
vec2 centre_of(Tile tile) {
    return vec2(tile.corner) + 0.5 * vec2(TILE);
}

// Moved back along the ray. `share`: see Meeting.
float pushed(float z, float share, float away) {
    return ORTHOGRAPHIC ? z - away : z / (share + z * away);
}

// Of numbers that are not both negative. Integers: a software device would look for numbers that are none.
float larger(float a, float b) {
    return intBitsToFloat(max(floatBitsToInt(a), floatBitsToInt(b)));
}
vec3 larger(vec3 a, vec3 b) {
    return intBitsToFloat(max(floatBitsToInt(a), floatBitsToInt(b)));
}
float smaller(float a, float b) {
    return intBitsToFloat(min(floatBitsToInt(a), floatBitsToInt(b)));
}

void see_block(uint block, const bool solids, inout Tile tile) {
    const uint lane = gl_LocalInvocationID.x;
    const uint splat_place = block * BLOCK + lane;
    const int texel = int(splat_place * RECORD_TEXELS);
    const SplatPlace place = unpack_place(texelFetch(record_texels, texel));
    const SplatPlane splat = unpack_plane(texelFetch(record_texels, texel + 1), texelFetch(record_texels, texel + 2));
    const vec2 d = first_pixel(tile) - place.anchor;
    TilePlane mine = plane_in_tile(place.z, splat, d);
    TileSolid my_solid;
    int my_speck = -1;
    if (solids) {
        const SplatSolid solid = read_solid(splat_place, splat.marks);
        const bool speck = (splat.marks & MARK_SPECK) != 0;
        mine.u += solid.plane_offset.x * mine.e;
        mine.v += solid.plane_offset.y * mine.e;
        my_solid = solid_in_tile(solid, mine, speck);
        my_speck = speck_pixel_of(speck, place.anchor, tile.corner);
    }
    uint left = subgroupBallot(touches_tile(place, centre_of(tile))).x;
    if (left != 0) do {
            const uint i = findLSB(left);
            left &= left - 1;
            const TilePlane plane = hand_round(mine, i);
            const float push = subgroupShuffle(splat.push, i);
            PixelPlane at = at_column(plane, float(lane));
            TileSolid solid;
        float clip_at = 0;
            int speck_pixel;
            if (solids) {
                solid = hand_round(my_solid, i);
                clip_at = solid.past_clip.x + solid.past_clip.y * float(lane);
            speck_pixel = subgroupShuffle(my_speck, i);
            }
            const float speck_z = subgroupShuffle(place.z, i);
            [[unroll]] for (int row = 0; row < TILE.y; ++row) {
                if (solids) {
                    const Meeting meeting = meet_solid(at, solid, clip_at);
                clip_at += solid.past_clip.z;
                    const bool on_speck = !meeting.on_disk && speck_pixel == int(lane) + row * int(TILE.x);
                    const float away = push * tile.along_axis[row] * (meeting.beside_disk ? BESIDE_PUSH : 1);
                    const float back = pushed(on_speck ? speck_z : meeting.z, on_speck ? 1 : meeting.share, away);
                    const bool met = meeting.on_disk || meeting.beside_disk || on_speck;
                    tile.visible[row] = met ? larger(tile.visible[row], back) : tile.visible[row];
                } else {
                    const Meeting meeting = meet_disk(at);
                    const float back = pushed(meeting.z, 1, push * tile.along_axis[row]);
                    tile.visible[row] = meeting.on_disk ? larger(tile.visible[row], back) : tile.visible[row];
                }
                at = next_row(at, plane);
            }
        } while (left != 0);
}

// The default kernel is exp(-x) for x in [0, 1], to 1e-5: Chebyshev interpolation.
float falloff(float x) {
    if (KERNEL != KERNEL_DISK) return other_kernel(min(x, KERNEL_SUPPORT2));
    return 0.99998916 + x * (-0.99945630 + x * (0.49556967 + x * (-0.15375046 + x * 0.025536540)));
}

void paint_block(uint block, const bool solids, inout Tile tile) {
    const uint lane = gl_LocalInvocationID.x;
    const uint splat_place = block * BLOCK + lane;
    const int texel = int(splat_place * RECORD_TEXELS);
    const SplatPlace place = unpack_place(texelFetch(record_texels, texel));
    const SplatPlane splat = unpack_plane(texelFetch(record_texels, texel + 1), texelFetch(record_texels, texel + 2));
    const SplatPaint paint = unpack_paint(splat, texelFetch(record_texels, texel + 3));
    const SplatFilter filtered = filter_of(splat);
    const vec2 d = first_pixel(tile) - place.anchor;
    TilePlane mine = plane_in_tile(place.z, splat, d);
    TileSolid my_solid;
    const bool speck = solids && (splat.marks & MARK_SPECK) != 0;
    int my_speck = -1;
    if (solids) {
        const SplatSolid solid = read_solid(splat_place, splat.marks);
        mine.u += solid.plane_offset.x * mine.e;
        mine.v += solid.plane_offset.y * mine.e;
        my_solid = solid_in_tile(solid, mine, speck);
        my_speck = speck_pixel_of(speck, place.anchor, tile.corner);
    }
    // Beyond the disk its plane may be anywhere; a speck's is its centre's.
    const float rise = speck ? 0 : splat.rise;
    const float nearest_z = ORTHOGRAPHIC ? place.z + rise : (rise < 1 ? place.z / (1 - rise) : 1e30);
    const float farthest_z = ORTHOGRAPHIC ? place.z - rise : place.z / (1 + rise);
    const float my_weight = VIEW == VIEW_OVERLAP ? 1 : filtered.weight;
    const vec3 my_colour = paint.colour * my_weight;
    const vec3 my_albedo =
        DEFERRED ? unpack_albedo(texelFetch(record_texels, int(tiles.first_solid + 2 * splat_place) + 1)) * my_weight
                 : vec3(0);
    const float bend = speck ? 0 : my_weight;
    // Colours change along the disk, e times as fast.
    const vec3 bend_u = paint.colour_u * bend, bend_v = paint.colour_v * bend;
    const vec3 my_bend = bend_u * mine.u.x + bend_v * mine.v.x;
    const vec3 bend_column = bend_u * mine.u.y + bend_v * mine.v.y, bend_row = bend_u * mine.u.z + bend_v * mine.v.z;
    // The ellipse, x^T V^-1 x / 2, as a polynomial of the column and of the row.
    const vec3 conic = filtered.conic * (KERNEL_MOMENT * vec3(1, 2, 1));
    const vec3 ellipse_column = vec3(conic.x * d.x * d.x + conic.y * d.x * d.y + conic.z * d.y * d.y,
                                     2 * conic.x * d.x + conic.y * d.y, conic.x);
    const vec3 ellipse_row = vec3(2 * conic.z * d.y + conic.y * d.x, conic.y, conic.z);

    uint left = subgroupBallot(touches_tile(place, centre_of(tile)) && nearest_z >= tile.farthest).x;
    if (left != 0) do {
            const uint i = findLSB(left);
            left &= left - 1;
            const float column = float(lane);
            const TilePlane plane = hand_round(mine, i);
            const vec2 z_ends = subgroupShuffle(vec2(farthest_z, nearest_z), i);
            const vec3 by_column = subgroupShuffle(ellipse_column, i), by_row = subgroupShuffle(ellipse_row, i);
            float ellipse = by_column.x + column * (by_column.y + column * by_column.z);
            float slope = by_row.x + column * by_row.y + by_row.z;
            const float weight = subgroupShuffle(my_weight, i);
            const vec3 colour = subgroupShuffle(my_colour, i);
            const vec3 albedo = DEFERRED ? subgroupShuffle(my_albedo, i) : vec3(0);
            vec3 bent = subgroupShuffle(my_bend, i) + column * subgroupShuffle(bend_column, i);
            const vec3 bent_step = subgroupShuffle(bend_row, i);
            PixelPlane at = at_column(plane, column);
            TileSolid solid;
        float clip_at = 0;
            vec3 cu, cv;
            int speck_pixel;
            if (solids) {
                solid = hand_round(my_solid, i);
                clip_at = solid.past_clip.x + solid.past_clip.y * float(lane);
            speck_pixel = subgroupShuffle(my_speck, i);
                cu = subgroupShuffle(bend_u, i);
                cv = subgroupShuffle(bend_v, i);
            }
            [[unroll]] for (int row = 0; row < TILE.y; ++row) {
                Meeting meeting;
                if (solids) {
                    meeting = meet_solid(at, solid, clip_at);
                    bent = cu * meeting.nearest.x + cv * meeting.nearest.y;
                } else {
                    meeting = meet_disk(at);
                }
                // Beyond the disk, the colour at its border; beyond the plane's horizon, that of its centre.
                const float across = solids ? dot(meeting.nearest, meeting.nearest) : meeting.distance2;
                const float scale = at.e > 0 ? inversesqrt(larger(across, at.e * at.e)) : 0;
                const float exponent = smaller(meeting.on_disk ? meeting.distance2 * scale * scale : KERNEL_SUPPORT2, ellipse);
                const float met_z = ORTHOGRAPHIC || !solids ? meeting.z : meeting.z / meeting.share;
                const float z = smaller(larger(met_z, z_ends.x), z_ends.y);
                bool cut_off = false;
            if (solids) {
                cut_off = clip_at > 0 && clip_at * clip_at > 0.25 * dot(solid.past_clip.yz, solid.past_clip.yz);
                clip_at += solid.past_clip.z;
            }
            bool reached = meeting.on_disk || (ellipse < KERNEL_SUPPORT2 && !cut_off);
                if (solids) reached = reached || meeting.beside_disk || speck_pixel == int(lane) + row * int(TILE.x);
                reached = reached && z >= tile.visible[row];
                if (VIEW == VIEW_OVERLAP) {
                    tile.sum[row].a += reached ? 1 : 0;
                } else {
                    const float part = reached ? (meeting.beside_disk ? BESIDE_WEIGHT : falloff(exponent)) : 0;
                    if (DEFERRED) {
                        tile.sum[row].rgb += part * albedo;
                        tile.normal_sum[row] += part * vec4(colour + bent * scale, weight * z);
                    } else if (VIEW == VIEW_DEPTH) {
                        tile.sum[row].rgb += part * weight * decode_depth(max(z, 1e-30));
                    } else {
                        tile.sum[row].rgb += part * larger(colour + bent * scale, vec3(0));
                    }
                    tile.sum[row].a += part * weight;
                }
                at = next_row(at, plane);
                bent += bent_step;
                ellipse += slope;
                slope += 2 * by_row.z;
            }
        } while (left != 0);
}

void see(const bool solids, uint blocks, inout Tile tile) {
    if (blocks == 0) return;
    uint n = 0;
    do {
        const uint own = min(n + gl_LocalInvocationID.x, blocks - 1);
        const uint block = touching[solids ? LAST_TOUCHING - own : own];
        const uint end = min(blocks - n, gl_WorkGroupSize.x);
        uint i = 0;
        do see_block(subgroupShuffle(block, i), solids, tile);
        while (++i < end);
        n += gl_WorkGroupSize.x;
    } while (n < blocks);
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

void paint(const bool solids, uint blocks, inout Tile tile) {
    if (blocks == 0 || tile.farthest > 1) return;
    uint n = 0;
    do {
        const uint own = min(n + gl_LocalInvocationID.x, blocks - 1);
        const uint block = touching[solids ? LAST_TOUCHING - own : own];
        const uint end = min(blocks - n, gl_WorkGroupSize.x);
        uint i = 0;
        do paint_block(subgroupShuffle(block, i), solids, tile);
        while (++i < end);
        n += gl_WorkGroupSize.x;
    } while (n < blocks);
}

void main() {
    const uint place = cells[(1 + CELLS) * cell_count() + gl_WorkGroupID.y];
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
    if (PART != PART_ATTRIBUTES) {
        if (CELLS != CELLS_SOLID) see(false, found.flat_blocks, tile);
        if (CELLS != CELLS_FLAT) see(true, found.solid_blocks, tile);
    }
    if (PART != PART_VISIBILITY) {
        own(tile);
        if (CELLS != CELLS_SOLID) paint(false, found.flat_blocks, tile);
        if (CELLS != CELLS_FLAT) paint(true, found.solid_blocks, tile);
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
