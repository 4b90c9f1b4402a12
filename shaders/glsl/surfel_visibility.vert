// Visibility pass: the depth of every surfel, moved back by epsilon (thesis 3.4.2).
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
#include "surfel_vertex.glsl"

layout(location = 0) flat out vec4 out_anchor_g;
layout(location = 1) flat out vec4 out_plane_map;
layout(location = 2) flat out vec4 out_depth_epsilon_offset;
layout(location = 3) flat out vec3 out_skew;
layout(location = 4) flat out vec2 out_swell;
layout(location = 5) flat out vec4 out_clip;

void main() {
    Splat splat;
    SurfelFrame surfel;
    const bool drawn = surfel_splat(vertex_record(), splat, surfel);
    place_primitive(drawn, splat.anchor, splat.disk_bounds);
    out_anchor_g = vec4(splat.anchor, splat.g);
    out_plane_map = splat.plane_map;
    out_depth_epsilon_offset =
        vec4(splat.anchor_depth, flagged(splat.epsilon, is_sub_pixel(splat)), splat.plane_offset);
    out_skew = splat.skew;
    out_swell = splat.swell;
    out_clip = splat.clip;
}
