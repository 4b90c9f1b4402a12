// From a record of setup back to what splat.glsl and the sprites' fragments work with. Needs frame.glsl, splat.glsl,
// surfel_frame.glsl, tile.glsl, splat_record.glsl.
#ifndef SPLICE_RECORDED_SPLAT_GLSL
#define SPLICE_RECORDED_SPLAT_GLSL

layout(set = 2, binding = 4) uniform usamplerBuffer record_texels;

struct RecordedSplat {
    Splat splat;   // without the bounds
    vec2 reach;    // around the anchor; nothing of it is farther
    uint marks;    // splat_record.glsl
    SplatPaint paint;
    vec3 albedo;   // deferred
};

bool is_speck(RecordedSplat recorded) { return (recorded.marks & MARK_SPECK) != 0; }

RecordedSplat recorded_splat(uint slot, const bool deferred) {
    const int texel = int(slot * RECORD_TEXELS);
    const int solid_texel = int(tiles.first_solid + 2 * slot);
    const SplatPlace place = unpack_place(texelFetch(record_texels, texel));
    const SplatPlane plane = unpack_plane(texelFetch(record_texels, texel + 1), texelFetch(record_texels, texel + 2));
    const uvec4 last = deferred || plane.marks != 0 ? texelFetch(record_texels, solid_texel + 1) : uvec4(0);
    const SplatSolid solid = unpack_solid(texelFetch(record_texels, solid_texel), last, plane.marks);
    const SplatFilter filtered = filter_of(plane);
    RecordedSplat recorded;
    recorded.marks = plane.marks;
    recorded.reach = place.reach;
    recorded.paint = unpack_paint(plane, texelFetch(record_texels, texel + 3));
    recorded.albedo = deferred ? unpack_albedo(last) : vec3(0);
    Splat splat;
    splat.anchor = place.anchor;
    splat.anchor_depth = decode_depth(place.z);
    const float depth_unit = ORTHOGRAPHIC ? depth_range() : splat.anchor_depth;
    splat.plane_map = plane.plane_map;
    splat.g = plane.g * (ORTHOGRAPHIC ? depth_unit : 1);
    splat.plane_offset = solid.plane_offset;
    splat.skew = vec3(solid.skew, solid.climb * depth_unit);
    splat.clip = clip_line(solid.clip, splat);
    splat.swell = solid.swell;
    splat.rise = plane.rise * depth_unit;
    splat.epsilon = plane.push * (ORTHOGRAPHIC ? depth_unit : frame.near_plane);
    splat.conic = filtered.conic;
    splat.weight = filtered.weight;
    recorded.splat = splat;
    return recorded;
}

#endif
