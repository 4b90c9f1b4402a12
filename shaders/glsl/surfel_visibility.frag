#version 460
#extension GL_GOOGLE_include_directive : require
#include "frame.glsl"
#include "splat.glsl"

layout(location = 0) flat in vec4 in_anchor_g;
layout(location = 1) flat in vec4 in_plane_map;
layout(location = 2) flat in vec4 in_depth_epsilon_offset;
layout(location = 3) flat in vec3 in_skew;
layout(location = 4) flat in vec2 in_swell;
layout(location = 5) flat in vec4 in_clip;

void main() {
    const vec2 pixel = gl_FragCoord.xy;
    const SplatHit hit = cast_ray(pixel, in_anchor_g.xy, in_plane_map, in_anchor_g.zw, in_depth_epsilon_offset.x,
                                  in_depth_epsilon_offset.zw, in_skew, in_swell, in_clip,
                                  in_depth_epsilon_offset.y < 0);
    if (!hit.on_disk && !hit.beside_disk) discard;
    const float epsilon = abs(in_depth_epsilon_offset.y) * (hit.beside_disk ? BESIDE_PUSH : 1);
    gl_FragDepth = encode_depth(push_back(hit.depth, epsilon, pixel));
}
