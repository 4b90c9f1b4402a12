// List of splats to rasterise, first step: from how many each group has, where they begin, and the draw.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "frame.glsl"
#include "tile.glsl"

layout(local_size_x = 256) in;

const uint VERTICES = 3;  // a splat

shared uint sums[gl_WorkGroupSize.x];

void main() {
    const uint lane = gl_LocalInvocationID.x;
    const uint share = (instance.surfel_count + gl_WorkGroupSize.x - 1) / gl_WorkGroupSize.x;
    const uint begin = min(lane * share, instance.surfel_count), end = min(begin + share, instance.surfel_count);
    uint own = 0;
    for (uint i = begin; i < end; ++i) own += list.first[instance.first_group + i];
    sums[lane] = own;
    barrier();
    for (uint distance = 1; distance < gl_WorkGroupSize.x; distance *= 2) {
        const uint before = lane >= distance ? sums[lane - distance] : 0;
        barrier();
        sums[lane] += before;
        barrier();
    }
    uint place = sums[lane] - own;
    for (uint i = begin; i < end; ++i) {
        const uint count = list.first[instance.first_group + i];
        list.first[instance.first_group + i] = place;
        place += count;
    }
    if (lane == gl_WorkGroupSize.x - 1) list.draw = uvec4(VERTICES * place, 1, 0, 0);
}
