// Point backend: small splats, scattered. An invocation has a splat and visits the few pixels that it may reach, with
// integer atomics for the depth test and for blending. Integers make both independent of order: the nearest depth is a
// maximum, sums are fixed point. Whoever includes this defines visit(). Needs frame.glsl, splat.glsl,
// surfel_frame.glsl, tile.glsl, splat_record.glsl, recorded_splat.glsl, splat_targets.glsl.
#ifndef SPLICE_POINT_SPLATS_GLSL
#define SPLICE_POINT_SPLATS_GLSL

layout(local_size_x = 8) in;

layout(set = 2, binding = 6) uniform usamplerBuffer block_texels;

void visit(RecordedSplat recorded, ivec2 pixel);

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
            visit(recorded, pixel);
            pixel = pixel.x < high.x ? ivec2(pixel.x + 1, pixel.y) : ivec2(low.x, pixel.y + 1);
        } while (pixel.y <= high.y);
    } while (++block < BLOCKS);
}

#endif
