// Point backend: what surfel_attribute.frag and deferred_attribute.frag compute.
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
#include "attribute_fragment.glsl"
#include "splat_targets.glsl"
#include "point_unit.glsl"
#include "point_splats.glsl"

void add(uint channel, float value) {
    const float whole = floor(value);
    const uint low = uint((value - whole) * 4294967296.0);
    uint high = uint(whole);
    const uint before = atomicAdd(point_sums[2 * channel], low);
    if (before + low < before) ++high;
    if (high != 0) atomicAdd(point_sums[2 * channel + 1], high);
}

void visit(RecordedSplat recorded, ivec2 pixel) {
    const Splat splat = recorded.splat;
    const AttributeFragment fragment = attribute_fragment(
        vec2(pixel) + 0.5, vec4(splat.anchor, splat.g), splat.plane_map, vec4(splat.conic, splat.weight),
        splat.anchor_depth, vec3(flagged(splat.rise, is_speck(recorded)), splat.plane_offset), splat.skew, splat.swell,
        splat.clip);
    const float z = encode_depth(fragment.depth);
    if (!fragment.reached || z < texelFetch(scene_depth, pixel, 0).r) return;
    const uint first = (pixel.y * uint(frame.viewport.x) + pixel.x) * CHANNELS;
    const SplatPaint by = recorded.paint;
    const vec3 value = by.colour + by.colour_u * fragment.uv.x + by.colour_v * fragment.uv.y;
    const float weight = VIEW == VIEW_OVERLAP ? 1 : fragment.weight;
    const vec3 colour = DEFERRED             ? recorded.albedo
                        : VIEW == VIEW_DEPTH ? vec3(fragment.depth / point_depth_unit())
                                             : max(value, 0);
    if (VIEW != VIEW_OVERLAP) {
        for (uint c = 0; c < 3; ++c) add(first + c, weight * colour[c]);
    }
    add(first + 3, weight);
    if (DEFERRED) {
        for (uint c = 0; c < 3; ++c) add(first + 4 + c, weight * max(value[c] + CHANNEL_BIAS, 0));
        add(first + 7, weight * z);
    }
}
