// Tile backend: visibility and attributes of a tile's pixels, gathered from its list (thesis 3.4.2 with the loops turned
// inside out). The formulas are those of surfel_visibility.frag and surfel_attribute.frag. An invocation has a column of
// the tile; what it reads of a splat is the same for all of them.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#extension GL_KHR_shader_subgroup_vote : require
#include "frame.glsl"
#include "splat.glsl"
#include "tile.glsl"

layout(local_size_x = 8) in;

layout(set = 2, binding = 6) uniform sampler2D triangle_depth;
layout(set = 2, binding = 7, rgba32f) uniform writeonly image2D accumulation;

void main() {
    const uint tile = gl_WorkGroupID.y * tiles.tiles_x + gl_WorkGroupID.x;
    const uint first = starts[tile];
    const uint end = min(starts[tile + 1], tiles.capacity);
    const ivec2 corner = ivec2(gl_WorkGroupID.xy * TILE) + ivec2(gl_LocalInvocationID.x, 0);
    const vec2 top = vec2(corner) + 0.5;

    float triangles[TILE.y], visible[TILE.y];
    [[unroll]] for (int row = 0; row < TILE.y; ++row)
        triangles[row] = visible[row] = texelFetch(triangle_depth, corner + ivec2(0, row), 0).r;

    for (uint i = first; i < end; ++i) {
        const uint splat = list[i];
        const vec4 anchor_g = uintBitsToFloat(records[splat].words[0]);
        const vec4 plane_map = uintBitsToFloat(records[splat].words[1]);
        const vec4 depth_epsilon_offset = uintBitsToFloat(records[splat].words[2]);
        const vec4 skew_rise = uintBitsToFloat(records[splat].words[3]);
        const vec2 swell = vec2(uintBitsToFloat(records[splat].words[6].w), uintBitsToFloat(records[splat].words[7].w));
        [[unroll]] for (int row = 0; row < TILE.y; ++row) {
            const vec2 pixel = top + vec2(0, row);
            const SplatHit hit = cast_ray(pixel, anchor_g.xy, plane_map, anchor_g.zw, depth_epsilon_offset.x,
                                          depth_epsilon_offset.zw, skew_rise.xyz, swell, depth_epsilon_offset.y < 0);
            const float epsilon = abs(depth_epsilon_offset.y) * (hit.beside_disk ? BESIDE_PUSH : 1);
            const float depth = encode_depth(push_back(hit.depth, epsilon, pixel));
            visible[row] = hit.on_disk || hit.beside_disk ? max(visible[row], depth) : visible[row];
        }
    }

    vec4 sum[TILE.y];
    bool owned = false;
    [[unroll]] for (int row = 0; row < TILE.y; ++row) {
        sum[row] = vec4(0);
        owned = owned || visible[row] > triangles[row];
    }
    const uint attribute_end = subgroupAny(owned) ? end : first;
    for (uint i = first; i < attribute_end; ++i) {
        const uint splat = list[i];
        const vec4 anchor_g = uintBitsToFloat(records[splat].words[0]);
        const vec4 plane_map = uintBitsToFloat(records[splat].words[1]);
        const vec4 depth_epsilon_offset = uintBitsToFloat(records[splat].words[2]);
        const vec4 skew_rise = uintBitsToFloat(records[splat].words[3]);
        const vec4 conic = uintBitsToFloat(records[splat].words[4]);
        const vec3 colour_centre = uintBitsToFloat(records[splat].words[5].xyz);
        const vec4 colour_u = uintBitsToFloat(records[splat].words[6]);
        const vec4 colour_v = uintBitsToFloat(records[splat].words[7]);
        const float anchor_depth = depth_epsilon_offset.x, rise = skew_rise.w;
        [[unroll]] for (int row = 0; row < TILE.y; ++row) {
            const vec2 pixel = top + vec2(0, row);
            const SplatHit hit = cast_ray(pixel, anchor_g.xy, plane_map, anchor_g.zw, depth_epsilon_offset.x,
                                          depth_epsilon_offset.zw, skew_rise.xyz, vec2(colour_u.w, colour_v.w),
                                          depth_epsilon_offset.y < 0);
            const vec2 d = pixel - anchor_g.xy;
            float exponent = 0.5 * (conic.x * d.x * d.x + 2 * conic.y * d.x * d.y + conic.z * d.y * d.y);
            const bool reached = hit.on_disk || hit.beside_disk || exponent < 1;
            exponent = min(min(exponent, hit.distance2), 1);
            const float depth = clamp(hit.depth, anchor_depth - rise, anchor_depth + rise);
            const bool shown = reached && encode_depth(depth) >= visible[row];
            if (VIEW == VIEW_OVERLAP) {
                sum[row] += shown ? vec4(1) : vec4(0);
                continue;
            }
            const float weight = conic.w * (hit.beside_disk ? BESIDE_WEIGHT : exp(-exponent));
            const vec2 uv = hit.uv * inversesqrt(max(dot(hit.uv, hit.uv), 1));
            const vec3 colour = max(colour_centre + colour_u.rgb * uv.x + colour_v.rgb * uv.y, 0);
            sum[row] += shown ? weight * vec4(VIEW == VIEW_DEPTH ? vec3(depth) : colour, 1) : vec4(0);
        }
    }
    [[unroll]] for (int row = 0; row < TILE.y; ++row)
        imageStore(accumulation, corner + ivec2(0, row), visible[row] > triangles[row] ? sum[row] : vec4(0));
}
