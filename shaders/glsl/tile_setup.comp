// Tile backend: every surfel of a range becomes the record of its splat and the tiles it touches, once a frame. Most
// surfels of a frame are cheap to reject: a workgroup, which is one subgroup, first finds which of its share are not,
// then works on those with all of its invocations.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#extension GL_KHR_shader_subgroup_ballot : require
#include "frame.glsl"
#include "octahedral.glsl"
#include "colour.glsl"
#include "lighting.glsl"
#include "splat.glsl"
#include "surfel_frame.glsl"
#include "tile.glsl"
#include "tile_record.glsl"

layout(local_size_x = 8) in;

// Surfels of a workgroup.
const uint SHARE = 64;
shared uint remaining[SHARE];

struct StoredSurfel {  // format::Surfel
    float x, y, z;
    uint radius_extent;
    uint normal;
    uint colour_bend_0;
    uint bend_1_4;
    uint patch_clip;
};
layout(set = 1, binding = 0, std430) readonly buffer Surfels { StoredSurfel surfels[]; };

SurfelRecord decode(StoredSurfel stored) {
    SurfelRecord record;
    record.position = vec3(stored.x, stored.y, stored.z);
    record.radius = unpackHalf2x16(stored.radius_extent).x;
    record.extent = stored.radius_extent >> 16;
    record.normal = unpackSnorm2x16(stored.normal);
    record.colour = unpackUnorm4x8(stored.colour_bend_0).rgb;
    record.bend_0 = unpackSnorm4x8(stored.colour_bend_0).w;
    record.bend_1_4 = unpackSnorm4x8(stored.bend_1_4);
    record.patch_number = stored.patch_clip & 0xffff;
    record.clip = stored.patch_clip >> 16;
    return record;
}

// The tiles of every pixel that the sprites of the same splat may reach.
uvec2 touched_tiles(Splat splat) {
    const vec2 low = max(min(splat.splat_bounds.xy, floor(splat.anchor)), vec2(0));
    const vec2 high = min(max(splat.splat_bounds.zw, floor(splat.anchor) + 1), frame.viewport);
    if (!all(lessThan(low, high))) return uvec2(0);
    const uvec2 first = uvec2(low) / TILE, beyond = (uvec2(ceil(high)) + TILE - 1) / TILE;
    return first | beyond << 16;
}

// Whether anything of a surfel can be in the picture; true when in doubt. Nothing it stands for is farther from its
// centre than a radius across and one along its normal.
bool may_show(StoredSurfel stored) {
    const vec3 centre = to_view_space(vec3(stored.x, stored.y, stored.z));
    const float depth = -centre.z;
    const float reach = sqrt(2.0) * unpackHalf2x16(stored.radius_extent).x * instance.scale;
    const vec2 half_view = (frame.viewport * 0.5 + PREFILTER_REACH) / frame.pixel_scale;
    const vec2 outside = ORTHOGRAPHIC ? abs(centre.xy) - half_view
                                      : (abs(centre.xy) - half_view * depth) * inversesqrt(1 + half_view * half_view);
    if (any(greaterThan(outside, vec2(reach))) || depth + reach < frame.near_plane) return false;
    if ((instance.flags & INSTANCE_TWO_SIDED) != 0) return true;
    return !beyond_horizon(normal_to_view_space(decode_octahedral(unpackSnorm2x16(stored.normal))), centre);
}

void record_surfel(uint index) {
    const SurfelRecord record = decode(surfels[instance.first_surfel + index]);
    const uint place = instance.first_splat + index;
    Splat splat;
    SurfelFrame surfel;
    if (!surfel_splat(record, splat, surfel)) return;
    const uvec2 touched = touched_tiles(splat);
    if (touched.x == 0) return;
    records[place] = pack_splat(record, splat, surfel_colour(record, surfel));
    splat_tiles[place] = touched;
}

void main() {
    // A dispatch is at most 65,535 workgroups wide.
    const uint first = (gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x) * SHARE;
    const uint end = min(first + SHARE, instance.surfel_count);
    const uint lane = gl_LocalInvocationID.x;
    uint kept = 0;
    for (uint batch = first; batch < end; batch += gl_WorkGroupSize.x) {
        const uint index = batch + lane;
        bool shows = false;
        if (index < end) {
            shows = may_show(surfels[instance.first_surfel + index]);
            splat_tiles[instance.first_splat + index] = uvec2(0);
        }
        const uvec4 all = subgroupBallot(shows);
        if (shows) remaining[kept + subgroupBallotExclusiveBitCount(all)] = index;
        kept += subgroupBallotBitCount(all);
    }
    memoryBarrierShared();
    barrier();
    for (uint i = lane; i < kept; i += gl_WorkGroupSize.x) record_surfel(remaining[i]);
}
