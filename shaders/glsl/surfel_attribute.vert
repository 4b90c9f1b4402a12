// Attribute pass: every surfel's lit colour, weighted by the EWA resampling filter (thesis 3.4.2), lit once a surfel.
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

void main() {
    Splat splat;
    vec3 centre, normal;
    const bool drawn = surfel_splat(splat, centre, normal);
    place_primitive(drawn, splat.anchor, splat.splat_bounds);
    const vec3 colour = view_colour(decode_srgb(in_colour.rgb), face_the_eye(normal, centre), centre, in_patch, true);
    out_anchor_g = vec4(splat.anchor, splat.g);
    out_plane_map = splat.plane_map;
    out_conic_weight = vec4(splat.conic, splat.weight);
    out_colour_depth = vec4(colour, splat.anchor_depth);
    out_rise_offset = vec3(splat.rise, splat.plane_offset);
}
