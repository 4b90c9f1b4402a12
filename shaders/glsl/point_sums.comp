// Point backend: fixed-point sums become those of the other backends, on top of what these have accumulated.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#include "frame.glsl"
#include "octahedral.glsl"
#include "colour.glsl"
#include "lighting.glsl"
#include "splat.glsl"
#include "surfel_record.glsl"
#include "surfel_frame.glsl"
#include "tile.glsl"
#include "splat_record.glsl"
#include "splat_targets.glsl"
#include "point_unit.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(constant_id = 0) const bool ADDS = false;  // to what is there

float total(uint channel) {
    return float(point_sums[2 * channel + 1]) + float(point_sums[2 * channel]) / 4294967296.0;
}

void main() {
    const ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, ivec2(frame.viewport)))) return;
    const uint first = (pixel.y * uint(frame.viewport.x) + pixel.x) * CHANNELS;
    vec4 sum = vec4(total(first), total(first + 1), total(first + 2), total(first + 3));
    vec4 normal_sum = vec4(0);
    if (DEFERRED)
        normal_sum = vec4(total(first + 4), total(first + 5), total(first + 6), total(first + 7)) -
                     vec4(vec3(CHANNEL_BIAS * sum.a), 0);
    if (VIEW == VIEW_DEPTH) sum.rgb *= point_depth_unit();
    if (ADDS) {
        sum += imageLoad(accumulation, pixel);
        if (DEFERRED) normal_sum += imageLoad(normals, pixel);
    }
    imageStore(accumulation, pixel, sum);
    if (DEFERRED) imageStore(normals, pixel, normal_sum);
}
