// Point backend: small splats, scattered. An invocation has a splat and visits the few pixels that it may reach: what
// surfel_visibility.frag and surfel_attribute.frag compute, with integer atomics for the depth test and for blending.
// Integers make both independent of order: the nearest depth is a maximum, sums are fixed point.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#include "frame.glsl"
#include "octahedral.glsl"
#include "colour.glsl"
#include "lighting.glsl"
#include "splat.glsl"
#include "surfel_frame.glsl"
#include "tile.glsl"
#include "splat_record.glsl"
#include "recorded_splat.glsl"
#include "attribute_fragment.glsl"
#include "splat_targets.glsl"
#include "point_unit.glsl"

layout(local_size_x = 8) in;

layout(constant_id = 0) const bool ATTRIBUTES = false;

layout(set = 2, binding = 6) uniform usamplerBuffer block_texels;

void add(uint channel, float value) {
    const float whole = floor(value);
    const uint low = uint((value - whole) * 4294967296.0);
    uint high = uint(whole);
    const uint before = atomicAdd(point_sums[2 * channel], low);
    if (before + low < before) ++high;
    if (high != 0) atomicAdd(point_sums[2 * channel + 1], high);
}

void see(RecordedSplat recorded, ivec2 pixel) {
    const Splat splat = recorded.splat;
    const vec2 centre = vec2(pixel) + 0.5;
    const SplatHit hit = cast_ray(centre, splat.anchor, splat.plane_map, splat.g, splat.anchor_depth,
                                  splat.plane_offset, splat.skew, splat.swell, splat.clip, is_speck(recorded));
    if (!hit.on_disk && !hit.beside_disk) return;
    const float epsilon = splat.epsilon * (hit.beside_disk ? BESIDE_PUSH : 1);
    const float z = encode_depth(push_back(hit.depth, epsilon, centre));
    if (z > 0) imageAtomicMax(splat_depth, pixel, floatBitsToUint(z));
}

void paint(RecordedSplat recorded, ivec2 pixel) {
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

void main() {
    const uint workgroup = gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
    if (workgroup >= instance.surfel_count) return;
    const uint group = instance.first_group + workgroup;
    uint block = 0;
    do {
        if (!block_reaches(texelFetch(block_texels, int(group * BLOCKS + block)).xy)) continue;
        const uint slot = group * GROUP + block * BLOCK + gl_LocalInvocationID.x;
        const SplatPlace place = unpack_place(texelFetch(record_texels, int(slot * RECORD_TEXELS)));
        if (!place_reaches(place)) continue;
        const RecordedSplat recorded = recorded_splat(slot, DEFERRED);
        const ivec2 low = ivec2(max(ceil(place.anchor - place.reach - 0.5), vec2(0)));
        const ivec2 high = ivec2(min(floor(place.anchor + place.reach - 0.5), frame.viewport - 1));
        if (any(lessThan(high, low))) continue;
        ivec2 pixel = low;
        do {
            if (ATTRIBUTES) {
                paint(recorded, pixel);
            } else {
                see(recorded, pixel);
            }
            pixel = pixel.x < high.x ? ivec2(pixel.x + 1, pixel.y) : ivec2(low.x, pixel.y + 1);
        } while (pixel.y <= high.y);
    } while (++block < BLOCKS);
}
