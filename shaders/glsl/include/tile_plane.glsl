// Splats in the coordinates of a tile of the tile backend: all that a pixel needs of a splat is affine in the pixel
// (splat.glsl), so rows are reached by addition. Needs frame.glsl, splat.glsl, tile.glsl, splat_record.glsl.
#ifndef SPLICE_TILE_PLANE_GLSL
#define SPLICE_TILE_PLANE_GLSL

bool touches_tile(SplatPlace place, vec2 tile_centre) {
    return all(lessThanEqual(abs(place.anchor - tile_centre), place.reach + 0.5 * vec2(TILE - 1)));
}

// Relative to the tile's first pixel: value there, change a column, change a row.
struct TilePlane {
    vec3 e, u, v;  // splat.glsl; orthographic: e is 1
    float z;       // orthographic: there, and z_step how it changes; perspective: of the anchor
    vec2 z_step;
};

TilePlane plane_in_tile(float z, SplatPlane splat, vec2 d) {
    TilePlane plane;
    const float gd = dot(splat.g, d);
    plane.e = ORTHOGRAPHIC ? vec3(1, 0, 0) : vec3(1 + gd, splat.g);
    plane.u = vec3(dot(splat.plane_map.xz, d), splat.plane_map.xz);
    plane.v = vec3(dot(splat.plane_map.yw, d), splat.plane_map.yw);
    plane.z = ORTHOGRAPHIC ? z + gd : z;
    plane.z_step = splat.g;
    return plane;
}

// A speck shows at its own pixel, at its centre's depth, even if the ray misses it, and nowhere else: its place is
// taken by a disk that faces the eye and meets that pixel's ray at its border, where splats weigh least.
const float SPECK_BORDER = 0.999, SPECK_SLOPE = 10;  // radii, and a pixel
TilePlane speck_in_tile(SplatPlace place, vec2 first_pixel) {
    const vec2 d = first_pixel - (floor(place.anchor) + 0.5);
    return TilePlane(vec3(1, 0, 0), vec3(SPECK_BORDER + SPECK_SLOPE * d.x, SPECK_SLOPE, 0),
                     vec3(SPECK_SLOPE * d.y, 0, SPECK_SLOPE), place.z, vec2(0));
}

TilePlane hand_round(TilePlane mine, uint i) {
    TilePlane plane;
    plane.e = subgroupShuffle(mine.e, i);
    plane.u = subgroupShuffle(mine.u, i);
    plane.v = subgroupShuffle(mine.v, i);
    plane.z = subgroupShuffle(mine.z, i);
    plane.z_step = subgroupShuffle(mine.z_step, i);
    return plane;
}

// The values at a pixel.
struct PixelPlane {
    float e, u, v, z;
};

PixelPlane at_column(TilePlane plane, float column) {
    return PixelPlane(plane.e.x + plane.e.y * column, plane.u.x + plane.u.y * column, plane.v.x + plane.v.y * column,
                      plane.z + (ORTHOGRAPHIC ? plane.z_step.x * column : 0));
}

PixelPlane next_row(PixelPlane at, TilePlane plane) {
    return PixelPlane(at.e + plane.e.z, at.u + plane.u.z, at.v + plane.v.z, at.z + (ORTHOGRAPHIC ? plane.z_step.y : 0));
}

// cast_ray of splat.glsl. `z`: perspective: the depth buffer value times `share`.
struct Meeting {
    bool on_disk, beside_disk;
    float z, share;
    vec2 nearest;     // e times the disk's coordinates
    float distance2;  // of the plane's point, e^2 times the square
};

Meeting meet_disk(PixelPlane at) {
    const float distance2 = at.u * at.u + at.v * at.v;
    return Meeting(distance2 <= at.e * at.e, false, ORTHOGRAPHIC ? at.z : at.z * at.e, 1, vec2(at.u, at.v), distance2);
}

// Moved back along the ray. `share`: see Meeting; `away`: small against the depth, in which it is 1 / (share + z away).
float pushed(float z, float share, float away) {
    return ORTHOGRAPHIC ? z - away : z / (share + z * away);
}

// Of numbers that are not both negative. Integers: a software device would look for numbers that are none.
float larger(float a, float b) {
    return intBitsToFloat(max(floatBitsToInt(a), floatBitsToInt(b)));
}
vec3 larger(vec3 a, vec3 b) {
    return intBitsToFloat(max(floatBitsToInt(a), floatBitsToInt(b)));
}
float smaller(float a, float b) {
    return intBitsToFloat(min(floatBitsToInt(a), floatBitsToInt(b)));
}

// The same of any numbers. Comparisons, for the same reason.
float highest(float a, float b) {
    return a < b ? b : a;
}
float lowest(float a, float b) {
    return a < b ? a : b;
}

#endif
