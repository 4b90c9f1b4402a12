// A splat as the tile backend records it. Needs splat.glsl, surfel_frame.glsl, tile.glsl.
#ifndef SPLICE_TILE_RECORD_GLSL
#define SPLICE_TILE_RECORD_GLSL

TileSplat pack_splat(Splat splat, SurfelColour colour) {
    TileSplat record;
    record.words[0] = floatBitsToUint(vec4(splat.anchor, splat.g));
    record.words[1] = floatBitsToUint(splat.plane_map);
    record.words[2] = floatBitsToUint(
        vec4(splat.anchor_depth, flagged(splat.epsilon, is_sub_pixel(splat)), splat.plane_offset));
    record.words[3] = floatBitsToUint(vec4(splat.skew, splat.rise));
    record.words[4] = floatBitsToUint(vec4(splat.conic, splat.weight));
    record.words[5] = floatBitsToUint(vec4(colour.centre, 0));
    record.words[6] = floatBitsToUint(vec4(colour.along_u, splat.swell.x));
    record.words[7] = floatBitsToUint(vec4(colour.along_v, splat.swell.y));
    return record;
}

#endif
