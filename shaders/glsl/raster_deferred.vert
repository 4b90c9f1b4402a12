// Raster backend: the vertices of deferred_attribute.frag.
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
#include "tile.glsl"
#include "splat_record.glsl"
#include "recorded_splat.glsl"
#include "raster_vertex.glsl"

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
    const RecordedSplat recorded = recorded_splat(listed_slot(), true);
    const Splat splat = recorded.splat;
    place_corner(recorded, footprint_variance());
    out_anchor_g = vec4(splat.anchor, splat.g);
    out_plane_map = splat.plane_map;
    out_conic_weight = vec4(splat.conic, splat.weight);
    out_skew = splat.skew;
    out_swell = splat.swell;
    out_clip = splat.clip;
    out_rise_offset = vec3(flagged(splat.rise, is_speck(recorded)), splat.plane_offset);
    out_normal_depth = vec4(recorded.paint.colour, splat.anchor_depth);
    out_normal_u = recorded.paint.colour_u;
    out_normal_v = recorded.paint.colour_v;
    out_albedo = recorded.albedo;
}
