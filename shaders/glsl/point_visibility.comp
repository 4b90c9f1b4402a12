// Point backend: what surfel_visibility.frag computes.
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
#include "splat_targets.glsl"
#include "point_splats.glsl"

void visit(RecordedSplat recorded, ivec2 pixel) {
    const Splat splat = recorded.splat;
    const vec2 centre = vec2(pixel) + 0.5;
    const SplatHit hit = cast_ray(centre, splat.anchor, splat.plane_map, splat.g, splat.anchor_depth,
                                  splat.plane_offset, splat.skew, splat.swell, splat.clip, is_speck(recorded));
    if (!hit.on_disk && !hit.beside_disk) return;
    const float epsilon = splat.epsilon * (hit.beside_disk ? BESIDE_PUSH : 1);
    const float z = encode_depth(push_back(hit.depth, epsilon, centre));
    if (z > 0) imageAtomicMax(splat_depth, pixel, floatBitsToUint(z));
}
