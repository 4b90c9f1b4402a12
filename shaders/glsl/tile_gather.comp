// Tile backend: visibility and attributes of a tile's pixels, gathered from its list: what surfel_visibility.frag and
// surfel_attribute.frag compute (thesis 3.4.2), with the loops turned inside out. An invocation has a column of the tile.
// Splats are read as many at once as there are invocations, one each, and brought into the tile's coordinates; then they
// are handed round one by one. All that a pixel needs of a splat is affine in the pixel (splat.glsl): rows are reached
// by addition.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#extension GL_KHR_shader_subgroup_arithmetic : require
#extension GL_KHR_shader_subgroup_ballot : require
#extension GL_KHR_shader_subgroup_shuffle : require
#include "frame.glsl"
#include "octahedral.glsl"
#include "colour.glsl"
#include "lighting.glsl"
#include "splat.glsl"
#include "surfel_frame.glsl"
#include "tile.glsl"
#include "tile_record.glsl"

layout(local_size_x = 8) in;

layout(set = 2, binding = 6) uniform sampler2D triangle_depth;
layout(set = 2, binding = 7, rgba32f) uniform writeonly image2D accumulation;

// Relative to the tile's first pixel: value there, change a column, change a row.
struct TilePlane {
    vec3 e, u, v;    // splat.glsl
    vec3 past_clip;
    float clip_change;  // perspective: less past_clip, over e
    float z;         // orthographic: e.x is 1 and z_step is how z changes
    vec2 z_step;
    vec2 skew;
    vec2 h;          // least and largest gain towards the axis
    float climb;
};

TilePlane plane_in_tile(TileRecord record, vec2 d) {
    TilePlane plane;
    const float gd = dot(record.g, d);
    plane.e = ORTHOGRAPHIC ? vec3(1, 0, 0) : vec3(1 + gd, record.g);
    plane.u = vec3(dot(record.plane_map.xz, d), record.plane_map.xz) + record.plane_offset.x * plane.e;
    plane.v = vec3(dot(record.plane_map.yw, d), record.plane_map.yw) + record.plane_offset.y * plane.e;
    plane.past_clip = record.clip.x * plane.u + record.clip.y * plane.v - record.clip.z * plane.e;
    plane.clip_change = dot(record.clip.xy, record.skew) + (ORTHOGRAPHIC ? 0 : record.clip.z);
    plane.z = ORTHOGRAPHIC ? record.z + gd : record.z;
    plane.z_step = record.g;
    plane.skew = record.skew;
    plane.climb = record.climb;
    const vec2 ends = vec2(-record.swell.y, record.swell.x) * (ORTHOGRAPHIC ? 1 : record.climb);
    // A speck shows at its own pixel and nowhere else.
    plane.h = record.speck ? vec2(0) : vec2(min(ends.x, ends.y), max(ends.x, ends.y));
    return plane;
}

TilePlane hand_round(TilePlane mine, uint i) {
    TilePlane plane;
    plane.e = subgroupShuffle(mine.e, i);
    plane.u = subgroupShuffle(mine.u, i);
    plane.v = subgroupShuffle(mine.v, i);
    plane.past_clip = subgroupShuffle(mine.past_clip, i);
    plane.clip_change = subgroupShuffle(mine.clip_change, i);
    plane.z = subgroupShuffle(mine.z, i);
    plane.z_step = subgroupShuffle(mine.z_step, i);
    plane.skew = subgroupShuffle(mine.skew, i);
    plane.h = subgroupShuffle(mine.h, i);
    plane.climb = subgroupShuffle(mine.climb, i);
    return plane;
}

// The values at a pixel.
struct PixelPlane {
    float e, u, v, z, past_clip;
};

PixelPlane at_column(TilePlane plane, float column) {
    return PixelPlane(plane.e.x + plane.e.y * column, plane.u.x + plane.u.y * column, plane.v.x + plane.v.y * column,
                      plane.z + (ORTHOGRAPHIC ? plane.z_step.x * column : 0),
                      plane.past_clip.x + plane.past_clip.y * column);
}

PixelPlane next_row(PixelPlane at, TilePlane plane) {
    return PixelPlane(at.e + plane.e.z, at.u + plane.u.z, at.v + plane.v.z,
                      at.z + (ORTHOGRAPHIC ? plane.z_step.y : 0), at.past_clip + plane.past_clip.z);
}

// cast_ray of splat.glsl without specks. `z`: perspective: the depth buffer value times `share`.
struct Meeting {
    bool on_disk, beside_disk;
    float z, share;
    vec2 nearest;    // e times the disk's coordinates
    float distance2; // of the plane's point, e^2 times the square
};

Meeting meet(PixelPlane at, TilePlane plane) {
    Meeting meeting;
    const float ee = at.e * at.e;
    const float uu = at.u * at.u + at.v * at.v;
    const float z = ORTHOGRAPHIC ? at.z : plane.z * at.e;
    meeting.distance2 = uu;
    // Beyond the plane's horizon e is below 0.
    const float past_clip = at.e < 0 ? -at.past_clip : at.past_clip;
    meeting.on_disk = uu <= ee && at.e > 0 && past_clip <= 0 && z <= 1;
    const vec2 q = ORTHOGRAPHIC ? plane.skew : vec2(at.u + plane.skew.x * at.e, at.v + plane.skew.y * at.e);
    const float uq = at.u * q.x + at.v * q.y;
    const float qq = q.x * q.x + q.y * q.y;
    // The part of the solid in front of the near plane: z / (1 + gain) or z - gain climb is at most 1 there.
    const float near_gain = ORTHOGRAPHIC ? (z - 1) / plane.climb : z - 1;
    const bool grows = ORTHOGRAPHIC ? plane.climb > 0 : at.e > 0;
    float low = grows ? max(plane.h.x, near_gain) : plane.h.x;
    float high = grows ? plane.h.y : min(plane.h.y, near_gain);
    // And on the side of the clip line that is kept.
    const float clip_change = plane.clip_change * (ORTHOGRAPHIC ? 1 : abs(at.e)) + (ORTHOGRAPHIC ? 0 : past_clip);
    const float clip_gain = -past_clip / clip_change;
    high = clip_change > 0 ? min(high, clip_gain) : high;
    low = clip_change < 0 ? max(low, clip_gain) : low;
    high = clip_change == 0 && past_clip > 0 ? low - 1 : high;
    const float gain = clamp(-uq / max(qq, 1e-30), low, high);
    meeting.beside_disk = !meeting.on_disk && low <= high && uu + gain * (2 * uq + gain * qq) <= ee;
    const float h = meeting.beside_disk ? gain : 0;
    meeting.share = ORTHOGRAPHIC ? 1 : 1 + h;
    meeting.z = ORTHOGRAPHIC ? z - h * plane.climb : z;
    meeting.nearest = vec2(at.u, at.v) + h * q;
    return meeting;
}

// Where in the tile a speck shows even if the ray misses it; -1: nowhere.
int speck_pixel_of(TileRecord record, uvec2 tile_corner) {
    const ivec2 pixel = ivec2(floor(record.anchor)) - ivec2(tile_corner);
    const bool shows = record.speck && all(greaterThanEqual(pixel, ivec2(0))) && all(lessThan(pixel, ivec2(TILE)));
    return shows ? pixel.x + pixel.y * int(TILE.x) : -1;
}

void main() {
    const uint tile = gl_WorkGroupID.y * tiles.tiles_x + gl_WorkGroupID.x;
    const uint first = starts[tile];
    const uint end = min(starts[tile + 1], tiles.capacity);
    const uint lane = gl_LocalInvocationID.x;
    const uvec2 tile_corner = gl_WorkGroupID.xy * TILE;
    const ivec2 corner = ivec2(tile_corner) + ivec2(lane, 0);
    const vec2 origin = vec2(tile_corner) + 0.5;

    float triangles[TILE.y], visible[TILE.y], along_axis[TILE.y];
    [[unroll]] for (int row = 0; row < TILE.y; ++row) {
        // Beyond the picture's edge any depth will do: what is stored there is dropped.
        const ivec2 pixel = min(corner + ivec2(0, row), ivec2(frame.viewport) - 1);
        triangles[row] = visible[row] = texelFetch(triangle_depth, pixel, 0).r;
        const vec2 off = (vec2(corner) + vec2(0.5, 0.5 + row) - frame.viewport * 0.5) / frame.pixel_scale;
        along_axis[row] = ORTHOGRAPHIC ? 1 : inversesqrt(1 + dot(off, off));
    }

    for (uint batch = first; batch < end; batch += TILE.x) {
        const TileRecord record = unpack_splat(records[list[min(batch + lane, end - 1)]]);
        const TilePlane mine = plane_in_tile(record, origin - record.anchor);
        const int speck = speck_pixel_of(record, tile_corner);
        const uint count = min(end - batch, TILE.x);
        for (uint i = 0; i < count; ++i) {
            const TilePlane plane = hand_round(mine, i);
            const float push = subgroupShuffle(record.push, i);
            const int speck_pixel = subgroupShuffle(speck, i);
            const float speck_z = subgroupShuffle(record.z, i);
            PixelPlane at = at_column(plane, float(lane));
            [[unroll]] for (int row = 0; row < TILE.y; ++row) {
                const Meeting meeting = meet(at, plane);
                const bool on_speck = !meeting.on_disk && speck_pixel == int(lane) + row * int(TILE.x);
                const float away = push * along_axis[row] * (meeting.beside_disk ? BESIDE_PUSH : 1);
                const float z = on_speck ? speck_z : meeting.z, share = on_speck ? 1 : meeting.share;
                const float pushed = ORTHOGRAPHIC ? z - away : z / (share + z * away);
                visible[row] = meeting.on_disk || meeting.beside_disk || on_speck ? max(visible[row], pushed) : visible[row];
                at = next_row(at, plane);
            }
        }
    }

    vec4 sum[TILE.y];
    float farthest = 2;
    bool owned[TILE.y];
    [[unroll]] for (int row = 0; row < TILE.y; ++row) {
        sum[row] = vec4(0);
        owned[row] = visible[row] > triangles[row];
        // What defined the depth passes the test against it, rounded or not.
        visible[row] -= visible[row] * 2.5e-7;
        farthest = owned[row] ? min(farthest, visible[row]) : farthest;
    }
    farthest = subgroupMin(farthest);
    const uint attribute_end = farthest <= 1 ? end : first;

    for (uint batch = first; batch < attribute_end; batch += TILE.x) {
        const TileRecord record = unpack_splat(records[list[min(batch + lane, end - 1)]]);
        const vec2 from_anchor = origin - record.anchor;
        const TilePlane mine = plane_in_tile(record, from_anchor);
        // Beyond the disk its plane may be anywhere; a speck's is its centre's.
        const float rise = record.speck ? 0 : record.rise;
        const float nearest_z = ORTHOGRAPHIC ? record.z + rise : (rise < 1 ? record.z / (1 - rise) : 1e30);
        const float farthest_z = ORTHOGRAPHIC ? record.z - rise : record.z / (1 + rise);
        const float weight = VIEW == VIEW_OVERLAP ? 1 : record.conic_weight.w;
        const vec3 conic = record.conic_weight.xyz * vec3(0.5, 1, 0.5);
        const vec3 colour = record.colour * weight;
        const float bend = record.speck ? 0 : weight;
        const vec3 colour_u = record.colour_u * bend, colour_v = record.colour_v * bend;
        const int speck = speck_pixel_of(record, tile_corner);
        uint left = subgroupBallot(batch + lane < end && nearest_z >= farthest).x;
        while (left != 0) {
            const uint i = findLSB(left);
            left &= left - 1;
            const TilePlane plane = hand_round(mine, i);
            const float half_pixel_past = 0.25 * dot(plane.past_clip.yz, plane.past_clip.yz);
            const vec2 z_ends = subgroupShuffle(vec2(farthest_z, nearest_z), i);
            const vec3 conic_i = subgroupShuffle(conic, i);
            const vec2 d = subgroupShuffle(from_anchor, i) + vec2(lane, 0);
            const float conic_xx = conic_i.x * d.x * d.x, conic_xy = conic_i.y * d.x;
            const int speck_pixel = subgroupShuffle(speck, i);
            const float weight_i = subgroupShuffle(weight, i);
            const vec3 c = subgroupShuffle(colour, i), cu = subgroupShuffle(colour_u, i), cv = subgroupShuffle(colour_v, i);
            PixelPlane at = at_column(plane, float(lane));
            float dy = d.y;
            [[unroll]] for (int row = 0; row < TILE.y; ++row) {
                const Meeting meeting = meet(at, plane);
                const float ee = at.e * at.e;
                const float across = dot(meeting.nearest, meeting.nearest);
                // Beyond the disk, the colour at its border; beyond the plane's horizon, that of its centre.
                const float scale = at.e > 0 ? inversesqrt(max(across, ee)) : 0;
                const float ellipse = conic_xx + dy * (conic_xy + conic_i.z * dy);
                const float exponent = min(meeting.on_disk ? meeting.distance2 * scale * scale : 1, ellipse);
                const float z_gained = ORTHOGRAPHIC ? meeting.z : meeting.z / meeting.share;
                const float z = clamp(z_gained, z_ends.x, z_ends.y);
                const bool cut_off = at.past_clip > 0 && at.past_clip * at.past_clip > half_pixel_past;
                const bool reached = (meeting.on_disk || meeting.beside_disk || (ellipse < 1 && !cut_off) || speck_pixel == int(lane) + row * int(TILE.x)) && z >= visible[row];
                const vec2 uv = meeting.nearest * scale;
                if (VIEW == VIEW_OVERLAP) {
                    sum[row].a += reached ? 1 : 0;
                } else {
                    const float share = meeting.beside_disk ? BESIDE_WEIGHT : exp(-min(exponent, 1));
                    const float part = reached ? share : 0;
                    if (VIEW == VIEW_DEPTH) {
                        sum[row].rgb += part * weight_i * decode_depth(max(z, 1e-30));
                    } else {
                        sum[row].rgb += part * max(c + cu * uv.x + cv * uv.y, 0);
                    }
                    sum[row].a += part * weight_i;
                }
                at = next_row(at, plane);
                dy += 1;
            }
        }
    }
    [[unroll]] for (int row = 0; row < TILE.y; ++row)
        imageStore(accumulation, corner + ivec2(0, row), owned[row] ? sum[row] : vec4(0));
}
