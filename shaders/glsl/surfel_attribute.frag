#version 460
#extension GL_GOOGLE_include_directive : require
#include "frame.glsl"
#include "splat.glsl"
#include "attribute_fragment.glsl"

layout(location = 0) flat in vec4 in_anchor_g;
layout(location = 1) flat in vec4 in_plane_map;
layout(location = 2) flat in vec4 in_conic_weight;
layout(location = 3) flat in vec4 in_colour_depth;
layout(location = 4) flat in vec3 in_rise_offset;
layout(location = 5) flat in vec3 in_colour_u;
layout(location = 6) flat in vec3 in_colour_v;
layout(location = 7) flat in vec3 in_skew;
layout(location = 8) flat in vec2 in_swell;
layout(location = 9) flat in vec4 in_clip;

layout(location = 0) out vec4 out_sum;  // blended one to one: (w rgb, w)

void main() {
    const AttributeFragment fragment =
        attribute_fragment(gl_FragCoord.xy, in_anchor_g, in_plane_map, in_conic_weight, in_colour_depth.w,
                           in_rise_offset, in_skew, in_swell, in_clip);
    if (!fragment.reached) discard;
    gl_FragDepth = encode_depth(fragment.depth);
    if (VIEW == VIEW_OVERLAP) {
        out_sum = vec4(1);
        return;
    }
    const vec3 colour = max(in_colour_depth.rgb + in_colour_u * fragment.uv.x + in_colour_v * fragment.uv.y, 0);
    out_sum = fragment.weight * vec4(VIEW == VIEW_DEPTH ? vec3(fragment.depth) : colour, 1);
}
