// A splat as the tile backend records it: what splat.glsl computes of it, in the units of the depth buffer, 96 bytes.
// Needs frame.glsl, splat.glsl, surfel_frame.glsl, tile.glsl.
#ifndef SPLICE_TILE_RECORD_GLSL
#define SPLICE_TILE_RECORD_GLSL

// Depth buffer values are encode_depth's, linear in the pixel along a plane:
//   perspective   z = z_P e / (1 + h),  h = what the ray gains towards the solid's axis; pushed back: 1/z grows
//   orthographic  z = z_P + g'.d - h s
struct TileRecord {
    vec2 anchor, g;     // splat.glsl; orthographic: g in depth buffer values a pixel
    vec4 plane_map;
    vec2 plane_offset;  // zero, or unit: as two 16-bit snorm
    float z;            // of the anchor
    float push;         // epsilon; perspective: over the near plane; orthographic: in depth buffer values
    bool speck;
    vec2 skew;
    float climb;        // perspective: change of h, orthographic: of z, a radius along the normal
    vec2 swell;         // radii; as the steps of surfel_extent.h
    vec3 clip;          // decode_clip; as in the model file
    float rise;         // the disk's depths as a share of the anchor's; orthographic: in depth buffer values; half
    vec4 conic_weight;
    vec3 colour, colour_u, colour_v;  // halves
};

float depth_range() { return frame.far_plane - frame.near_plane; }

TileSplat pack_splat(SurfelRecord surfel, Splat splat, SurfelColour colour) {
    const float to_z = ORTHOGRAPHIC ? 1 / depth_range() : 1;
    const float push = splat.epsilon * (ORTHOGRAPHIC ? to_z : 1 / frame.near_plane);
    const float climb = splat.skew.z * (ORTHOGRAPHIC ? to_z : 1 / splat.anchor_depth);
    // Rounded up, so that nothing on the disk is beyond it.
    const float rise = splat.rise * (ORTHOGRAPHIC ? to_z : 1 / splat.anchor_depth) * (1 + 1.0 / 512) + 1e-7;
    TileSplat record;
    record.words[0] = floatBitsToUint(vec4(splat.anchor, splat.g * to_z));
    record.words[1] = floatBitsToUint(splat.plane_map);
    record.words[2] = floatBitsToUint(
        vec4(encode_depth(splat.anchor_depth), flagged(push, is_sub_pixel(splat)), splat.skew.xy));
    const uint solid = VIEW == VIEW_SAMPLES ? 0 : surfel.extent & 1023 | surfel.clip << 16;
    record.words[3] = uvec4(solid, packHalf2x16(vec2(colour.along_v.b, min(rise, 6e4))),
                            packSnorm2x16(splat.plane_offset), floatBitsToUint(climb));
    record.words[4] = floatBitsToUint(vec4(splat.conic, splat.weight));
    record.words[5] = uvec4(packHalf2x16(colour.centre.rg), packHalf2x16(vec2(colour.centre.b, colour.along_u.r)),
                            packHalf2x16(colour.along_u.gb), packHalf2x16(colour.along_v.rg));
    return record;
}

TileRecord unpack_splat(TileSplat packed) {
    const vec4 depths = uintBitsToFloat(packed.words[2]);
    const vec2 blue_rise = unpackHalf2x16(packed.words[3].y);
    const vec2 blue_red = unpackHalf2x16(packed.words[5].y);
    TileRecord record;
    record.anchor = uintBitsToFloat(packed.words[0].xy);
    record.g = uintBitsToFloat(packed.words[0].zw);
    record.plane_map = uintBitsToFloat(packed.words[1]);
    record.plane_offset = unpackSnorm2x16(packed.words[3].z);
    record.z = depths.x;
    record.push = abs(depths.y);
    record.speck = depths.y < 0;
    record.skew = depths.zw;
    record.climb = uintBitsToFloat(packed.words[3].w);
    record.swell = decode_extent(packed.words[3].x & 1023).xy;
    record.clip = decode_clip(packed.words[3].x >> 16);
    record.rise = blue_rise.y;
    record.conic_weight = uintBitsToFloat(packed.words[4]);
    record.colour = vec3(unpackHalf2x16(packed.words[5].x), blue_red.x);
    record.colour_u = vec3(blue_red.y, unpackHalf2x16(packed.words[5].z));
    record.colour_v = vec3(unpackHalf2x16(packed.words[5].w), blue_rise.x);
    return record;
}

#endif
