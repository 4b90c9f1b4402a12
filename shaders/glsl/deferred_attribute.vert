// Attribute pass of deferred shading: every surfel's normal, to first order, and albedo, weighted as colours are.
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
layout(location = 2) flat out vec4 out_conic_weight;
layout(location = 3) flat out vec4 out_normal_depth;
layout(location = 4) flat out vec3 out_rise_offset;
layout(location = 5) flat out vec3 out_normal_u;  // change a radius
layout(location = 6) flat out vec3 out_normal_v;
layout(location = 7) flat out vec3 out_skew;
layout(location = 8) flat out vec2 out_swell;
layout(location = 9) flat out vec3 out_albedo;
layout(location = 10) flat out vec4 out_clip;

void main() {
    Splat splat;
    SurfelFrame surfel;
    const bool drawn = surfel_splat(vertex_record(), splat, surfel);
    place_primitive(drawn, splat.anchor, splat.splat_bounds);
    const SurfelNormals normals = surfel_normals(vertex_record(), surfel);
    out_normal_u = normals.along_u;
    out_normal_v = normals.along_v;
    out_anchor_g = vec4(splat.anchor, splat.g);
    out_plane_map = splat.plane_map;
    out_conic_weight = vec4(splat.conic, splat.weight);
    out_normal_depth = vec4(normals.centre, splat.anchor_depth);
    out_skew = splat.skew;
    out_swell = splat.swell;
    out_clip = splat.clip;
    out_rise_offset = vec3(flagged(splat.rise, is_sub_pixel(splat)), splat.plane_offset);
    out_albedo = surfel_albedo(vertex_record());
}
