// Attribute pass: every surfel's lit colour, weighted by the EWA resampling filter (thesis 3.4.2). Lit once a surfel, to
// first order: the colour at the centre and how it changes along both tangents, as the shading normal turns.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "frame.glsl"
#include "octahedral.glsl"
#include "colour.glsl"
#include "lighting.glsl"
#include "splat.glsl"
#include "surfel_vertex.glsl"

layout(location = 0) flat out vec4 out_anchor_g;
layout(location = 1) flat out vec4 out_plane_map;
layout(location = 2) flat out vec4 out_conic_weight;
layout(location = 3) flat out vec4 out_colour_depth;
layout(location = 4) flat out vec3 out_rise_offset;
layout(location = 5) flat out vec3 out_colour_u;  // change a radius
layout(location = 6) flat out vec3 out_colour_v;
layout(location = 7) flat out vec3 out_skew;
layout(location = 8) flat out vec2 out_swell;

// format::kLargestBend
const vec2 LARGEST_LEAN = vec2(1);
const vec3 LARGEST_TURN = vec3(0.5);

// `side`: 1, or -1 where a two-sided surface is seen from behind. `uv`: on the disk, in radii.
vec3 colour_at(SurfelFrame surfel, float side, vec2 uv) {
    const vec2 lean = LARGEST_LEAN * vec2(in_bend_0, in_bend_1_4.x);
    const vec3 turn = LARGEST_TURN * in_bend_1_4.yzw;
    const vec2 tilt = lean + vec2(dot(turn.xy, uv), dot(turn.yz, uv));
    const vec3 normal = normalize(surfel.normal + tilt.x * surfel.s + tilt.y * surfel.t);
    const vec3 position = surfel.centre + surfel.radius * (uv.x * surfel.s + uv.y * surfel.t);
    return view_colour(decode_srgb(in_colour.rgb), side * normal, position, in_patch, true);
}

void main() {
    Splat splat;
    SurfelFrame surfel;
    const bool drawn = surfel_splat(splat, surfel);
    place_primitive(drawn, splat.anchor, splat.splat_bounds);
    const float side = dot(face_the_eye(surfel.normal, surfel.centre), surfel.normal) < 0 ? -1 : 1;
    const vec3 colour = colour_at(surfel, side, vec2(0));
    out_colour_u = 0.5 * (colour_at(surfel, side, vec2(1, 0)) - colour_at(surfel, side, vec2(-1, 0)));
    out_colour_v = 0.5 * (colour_at(surfel, side, vec2(0, 1)) - colour_at(surfel, side, vec2(0, -1)));
    out_anchor_g = vec4(splat.anchor, splat.g);
    out_plane_map = splat.plane_map;
    out_conic_weight = vec4(splat.conic, splat.weight);
    out_colour_depth = vec4(colour, splat.anchor_depth);
    out_skew = splat.skew;
    out_swell = splat.swell;
    out_rise_offset = vec3(flagged(splat.rise, is_sub_pixel(splat)), splat.plane_offset);
}
