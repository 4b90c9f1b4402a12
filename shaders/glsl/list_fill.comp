// List of splats to rasterise, second step: the places of the records of a group that hold a splat, in order.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#extension GL_KHR_shader_subgroup_basic : require
#extension GL_KHR_shader_subgroup_ballot : require
#include "frame.glsl"
#include "splat.glsl"
#include "octahedral.glsl"
#include "colour.glsl"
#include "lighting.glsl"
#include "surfel_record.glsl"
#include "surfel_frame.glsl"
#include "tile.glsl"
#include "splat_record.glsl"

layout(local_size_x = 8) in;

layout(set = 2, binding = 4) uniform usamplerBuffer record_texels;
layout(set = 2, binding = 6) uniform usamplerBuffer block_texels;

void main() {
    const uint workgroup = gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
    if (workgroup >= instance.surfel_count) return;
    const uint group = instance.first_group + workgroup;
    uint place = tiles.first_listed - 4 + list.first[group];
    uint block = 0;
    do {
        if (block_reaches(texelFetch(block_texels, int(group * BLOCKS + block)).xy)) {
            const uint slot = group * GROUP + block * BLOCK + gl_LocalInvocationID.x;
            const bool shows = place_reaches(unpack_place(texelFetch(record_texels, int(slot * RECORD_TEXELS))));
            const uvec4 all = subgroupBallot(shows);
            if (shows) list.first[place + subgroupBallotExclusiveBitCount(all)] = slot;
            place += subgroupBallotBitCount(all);
        }
    } while (++block < BLOCKS);
}
