// A splat as setup records it, for every backend but the sprites: what splat.glsl computes of it, in the units of the
// depth buffer. Flat splats, those of disks and not of solids, have the first four, a line of a cache; those of solids
// and cut disks lie behind them all. Needs frame.glsl, splat.glsl,
// surfel_frame.glsl, tile.glsl.
//   0  anchor, reach around it (halves), z
//   1  plane_map
//   2  g, push with the marks in its last bits, rise and blue's change along v (halves)
//   3  colour, its change along u, its change along v but for blue (halves); deferred: the normal instead, its xyz for
//      rgb
//   4  skew, climb, plane_offset
//   5  direction of the clip line, red and green of the albedo, its blue (halves) and the clip line's offset (16 bits),
//      swell as format::Surfel stores it; of flat splats the albedo alone, where shading is deferred
#ifndef SPLICE_SPLAT_RECORD_GLSL
#define SPLICE_SPLAT_RECORD_GLSL

const uint MARKS = 0xf;
const uint MARK_SPECK = 1;
const uint MARK_NEAR = 2;   // crosses the near plane
const uint MARK_CUT = 4;    // by a line
const uint MARK_SWELL = 8;  // reaches above its plane or below

float depth_range() {
    return frame.far_plane - frame.near_plane;
}

struct SplatPlace {
    vec2 anchor, reach;
    float z;
};

SplatPlace unpack_place(uvec4 texel) {
    return SplatPlace(uintBitsToFloat(texel.xy), unpackHalf2x16(texel.z), uintBitsToFloat(texel.w));
}

// Of a record that holds a splat.
bool place_reaches(SplatPlace place) { return place.reach.x > -1e3; }

// `reach` is rounded up.
uvec4 pack_place(vec2 anchor, vec2 reach, float z) {
    return uvec4(floatBitsToUint(anchor), packHalf2x16(reach * (1 + 1.0 / 512) + 1.0 / 64), floatBitsToUint(z));
}

// Of what a solid gains towards its axis; tiles leave those that may gain less to another way of meeting them.
const float LEAST_GAIN = -0.9;
// Pixels: of larger ones, what is met beside the disk is worth looking for everywhere.
const uint LARGE_SOLID = 12;

// Depth buffer values are encode_depth's, linear in the pixel along a plane:
//   perspective   z = z_P e / (1 + h),  h = what the ray gains towards the solid's axis; pushed back: 1/z grows
//   orthographic  z = z_P + g'.d - h s,  g' = g in depth buffer values a pixel
struct SplatPlane {
    vec4 plane_map;
    vec2 g;
    float push;  // epsilon; perspective: over the near plane; orthographic: in depth buffer values
    float rise;  // the disk's depths as a share of the anchor's; orthographic: in depth buffer values
    float blue_v;
    uint marks;
};

SplatPlane unpack_plane(uvec4 map, uvec4 texel) {
    const vec2 rise_blue = unpackHalf2x16(texel.w);
    return SplatPlane(uintBitsToFloat(map), uintBitsToFloat(texel.xy), uintBitsToFloat(texel.z & ~MARKS), rise_blue.x,
                      rise_blue.y, texel.z & MARKS);
}

struct SplatSolid {
    vec2 skew;
    float climb;        // perspective: change of h, orthographic: of z, a radius along the normal
    vec2 swell;         // radii
    vec2 plane_offset;  // zero, or unit
    vec3 clip;          // decode_clip
};

const float CLIP_OFFSET_STEPS = 65535;

// Flat splats have no texels of this kind: anything may be there.
bool is_flat(uint marks) { return (marks & ~MARK_SPECK) == 0; }
vec3 unpack_clip(uvec4 last, uint marks) {
    if (is_flat(marks)) return NO_CLIP;
    return vec3(unpackSnorm2x16(last.x), float(last.z >> 16) * (1 / CLIP_OFFSET_STEPS));
}
SplatSolid unpack_solid(uvec4 texel, uvec4 last, uint marks) {
    if (is_flat(marks)) return SplatSolid(vec2(0), 1, vec2(0), vec2(0), NO_CLIP);
    const vec3 depths = uintBitsToFloat(texel.xyz);
    return SplatSolid(depths.xy, depths.z, decode_extent(last.w).xy, unpackSnorm2x16(texel.w),
                      unpack_clip(last, marks));
}

// NO_CLIP included. `swell`: EXTENT_SWELL of the record's extent.
uvec4 pack_last(vec3 clip, uint swell, vec3 albedo) {
    const uint blue = packHalf2x16(vec2(albedo.b, 0)) & 0xffff;
    return uvec4(packSnorm2x16(clip.xy), packHalf2x16(albedo.rg),
                 blue | uint(round(clip.z * CLIP_OFFSET_STEPS)) << 16, swell);
}

struct SplatPaint {
    vec3 colour, colour_u, colour_v;
};

SplatPaint unpack_paint(SplatPlane splat, uvec4 texel) {
    const vec2 blue_red = unpackHalf2x16(texel.y);
    SplatPaint paint;
    paint.colour = vec3(unpackHalf2x16(texel.x), blue_red.x);
    paint.colour_u = vec3(blue_red.y, unpackHalf2x16(texel.z));
    paint.colour_v = vec3(unpackHalf2x16(texel.w), splat.blue_v);
    return paint;
}

// Of deferred shading.
vec3 unpack_albedo(uvec4 texel) { return vec3(unpackHalf2x16(texel.y), unpackHalf2x16(texel.z).x); }

struct SplatFilter {
    vec3 conic;
    float weight;
};

// What make_splat computes, from the inverse A of its J: V = J J^T / 2 + p I (1/2 or another kernel's moment),
// J J^T = S^-1 with S = A^T A, and with
// Q = |S| |V| both V^-1 = (S / 2 + p |S| I) / Q and |J| / (2 sqrt|V|) = 1 / (2 sqrt Q) need no division by |S|.
SplatFilter filter_of(SplatPlane splat) {
    if (frame.prefilter == 0 && KERNEL_SUPPORT <= 1) return SplatFilter(vec3(NOWHERE, 0, NOWHERE), 1);
    const float filtered = frame.prefilter == 0 ? 1e-4 : PREFILTER;
    const vec4 a = splat.plane_map;
    const vec3 s = vec3(dot(a.xy, a.xy), dot(a.xy, a.zw), dot(a.zw, a.zw));
    const float area = a.x * a.w - a.y * a.z, determinant = area * area;
    const float q = KERNEL_MOMENT * KERNEL_MOMENT + KERNEL_MOMENT * filtered * (s.x + s.z) +
                    filtered * filtered * determinant;
    const bool near = (splat.marks & MARK_NEAR) != 0;
    SplatFilter result;
    result.conic = (KERNEL_MOMENT * s + filtered * determinant * vec3(1, 0, 1)) / q;
    result.weight = max(KERNEL_MOMENT * inversesqrt(q), MIN_WEIGHT);
    if (near) result = SplatFilter(vec3(NOWHERE, 0, NOWHERE), 1);
    return result;
}

#endif
