// Tile backend: every surfel of a range becomes the record of its splat and the tiles it touches, once a frame.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#include "frame.glsl"
#include "octahedral.glsl"
#include "colour.glsl"
#include "lighting.glsl"
#include "splat.glsl"
#include "surfel_frame.glsl"
#include "tile.glsl"
#include "tile_record.glsl"

layout(local_size_x = 64) in;

struct StoredSurfel {  // format::Surfel
    float x, y, z;
    uint radius_extent;
    uint normal;
    uint colour_bend_0;
    uint bend_1_4;
    uint patch_number;
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
    record.patch_number = stored.patch_number;
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

void main() {
    // A dispatch is at most 65,535 workgroups wide.
    const uint index = (gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x) * gl_WorkGroupSize.x +
                       gl_LocalInvocationID.x;
    if (index >= instance.surfel_count) return;
    const SurfelRecord record = decode(surfels[instance.first_surfel + index]);
    Splat splat;
    SurfelFrame surfel;
    const uint place = instance.first_splat + index;
    uvec2 touched = uvec2(0);
    if (surfel_splat(record, splat, surfel)) {
        touched = touched_tiles(splat);
        if (touched.x != 0) records[place] = pack_splat(splat, surfel_colour(record, surfel));
    }
    splat_tiles[place] = touched;
}
