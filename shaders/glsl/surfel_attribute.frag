#version 460
#extension GL_GOOGLE_include_directive : require
#include "frame.glsl"
#include "splat.glsl"

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
    const vec2 pixel = gl_FragCoord.xy;
    const float anchor_depth = in_colour_depth.w;
    const SplatHit hit = cast_ray(pixel, in_anchor_g.xy, in_plane_map, in_anchor_g.zw, anchor_depth, in_rise_offset.yz,
                                  in_skew, in_swell, in_clip, in_rise_offset.x < 0);
    const vec2 d = pixel - in_anchor_g.xy;
    const vec3 conic = in_conic_weight.xyz;
    // x^T V^-1 x / 2. The affine ellipse holds the disk except where perspective bends it; there the disk itself takes
    // over, so that no pixel that the visibility pass wrote is left without a weight.
    float exponent = 0.5 * (conic.x * d.x * d.x + 2 * conic.y * d.x * d.y + conic.z * d.y * d.y);
    if (!hit.on_disk && !hit.beside_disk && (exponent >= 1 || hit.cut_off)) discard;
    exponent = min(min(exponent, hit.distance2), 1);
    // Tested against the pushed-back depth of the visibility pass. Beyond the disk its plane may be anywhere.
    const float rise = abs(in_rise_offset.x);
    const float depth = clamp(hit.depth, anchor_depth - rise, anchor_depth + rise);
    gl_FragDepth = encode_depth(depth);
    if (VIEW == VIEW_OVERLAP) {
        out_sum = vec4(1);
        return;
    }
    const float weight = in_conic_weight.w * (hit.beside_disk ? BESIDE_WEIGHT : exp(-exponent));
    const vec2 uv = hit.uv * inversesqrt(max(dot(hit.uv, hit.uv), 1));  // no extrapolation beyond the disk
    const vec3 colour = max(in_colour_depth.rgb + in_colour_u * uv.x + in_colour_v * uv.y, 0);
    out_sum = weight * vec4(VIEW == VIEW_DEPTH ? vec3(depth) : colour, 1);
}
