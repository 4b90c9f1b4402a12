#version 460
#extension GL_GOOGLE_include_directive : require
#include "frame.glsl"
#include "splat.glsl"

layout(location = 0) flat in vec2 in_anchor;
layout(location = 1) flat in vec4 in_plane_map;
layout(location = 2) flat in vec4 in_plane;
layout(location = 3) flat in vec4 in_offset_interval;
layout(location = 4) flat in float in_epsilon;

void main() {
    const vec2 pixel = gl_FragCoord.xy;
    const SplatHit hit =
        cast_ray(pixel, in_anchor, in_plane_map, in_plane, in_offset_interval.xy, in_offset_interval.zw);
    if (!hit.on_disk) discard;
    gl_FragDepth = encode_depth(push_back(hit.depth, in_epsilon, pixel));
}
