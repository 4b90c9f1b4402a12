#version 460
#extension GL_GOOGLE_include_directive : require
#include "frame.glsl"
#include "splat.glsl"

layout(location = 0) flat in vec4 in_anchor_g;
layout(location = 1) flat in vec4 in_plane_map;
layout(location = 2) flat in vec4 in_depth_epsilon_offset;

void main() {
    const vec2 pixel = gl_FragCoord.xy;
    const SplatHit hit = cast_ray(pixel, in_anchor_g.xy, in_plane_map, in_anchor_g.zw, in_depth_epsilon_offset.x,
                                  in_depth_epsilon_offset.zw, in_depth_epsilon_offset.y < 0);
    if (!hit.on_disk) discard;
    gl_FragDepth = encode_depth(push_back(hit.depth, abs(in_depth_epsilon_offset.y), pixel));
}
