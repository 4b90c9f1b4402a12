// Visibility pass: the depth of every surfel, moved back by epsilon (thesis 3.4.2).
#version 460
#extension GL_GOOGLE_include_directive : require
#include "frame.glsl"
#include "octahedral.glsl"
#include "splat.glsl"
#include "surfel_vertex.glsl"

layout(location = 0) flat out vec2 out_anchor;
layout(location = 1) flat out vec4 out_plane_map;
layout(location = 2) flat out vec4 out_plane;
layout(location = 3) flat out vec4 out_offset_interval;
layout(location = 4) flat out float out_epsilon;

void main() {
    Splat splat;
    SurfelFrame surfel;
    const bool drawn = surfel_splat(splat, surfel);
    place_primitive(drawn, splat.anchor, splat.disk_bounds);
    out_anchor = splat.anchor;
    out_plane_map = splat.plane_map;
    out_plane = splat.plane;
    out_offset_interval = vec4(splat.plane_offset, splat.interval);
    out_epsilon = splat.epsilon;
}
