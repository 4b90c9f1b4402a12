#version 460
#extension GL_GOOGLE_include_directive : require
#include "frame.glsl"
#include "splat.glsl"
#include "attribute_fragment.glsl"

layout(location = 0) flat in vec4 in_anchor_g;
layout(location = 1) flat in vec4 in_plane_map;
layout(location = 2) flat in vec4 in_conic_weight;
layout(location = 3) flat in vec4 in_normal_depth;
layout(location = 4) flat in vec3 in_rise_offset;
layout(location = 5) flat in vec3 in_normal_u;
layout(location = 6) flat in vec3 in_normal_v;
layout(location = 7) flat in vec3 in_skew;
layout(location = 8) flat in vec2 in_swell;
layout(location = 9) flat in vec3 in_albedo;
layout(location = 10) flat in vec4 in_clip;

// Blended one to one.
layout(location = 0) out vec4 out_albedo_sum;  // (w rgb, w)
layout(location = 1) out vec4 out_normal_sum;  // (w n, w z), z as the depth buffer encodes it

void main() {
    const AttributeFragment fragment =
        attribute_fragment(gl_FragCoord.xy, in_anchor_g, in_plane_map, in_conic_weight, in_normal_depth.w,
                           in_rise_offset, in_skew, in_swell, in_clip);
    if (!fragment.reached) discard;
    gl_FragDepth = encode_depth(fragment.depth);
    const vec3 normal = in_normal_depth.xyz + in_normal_u * fragment.uv.x + in_normal_v * fragment.uv.y;
    out_albedo_sum = fragment.weight * vec4(in_albedo, 1);
    out_normal_sum = fragment.weight * vec4(normal, encode_depth(fragment.depth));
}
