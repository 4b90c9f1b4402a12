// Solids of splats (splat.glsl) in the coordinates of a tile. Two ways to meet them: meet_close_solid computes what
// cast_ray does; meet_solid does with one division, but nothing may be near the eye. Needs tile_plane.glsl.
#ifndef SPLICE_TILE_SOLID_GLSL
#define SPLICE_TILE_SOLID_GLSL

struct TileSolid {
    float clip_change;  // what a gain of 1 towards the axis adds to past_clip_in_tile; perspective: over e, less it
    vec2 skew;          // the same of (u, v)
    vec2 h;             // least and largest gain
    float climb;        // orthographic: the same of the depth buffer value
};

// As TilePlane: above 0 where the line cuts the disk off.
vec3 past_clip_in_tile(vec3 clip, TilePlane plane) {
    vec3 past_clip = clip.x * plane.u + clip.y * plane.v - clip.z * plane.e;
    past_clip.x -= CLIP_SLACK * length(past_clip.yz);
    return past_clip;
}

TileSolid solid_in_tile(SplatSolid solid) {
    const vec2 ends = vec2(-solid.swell.y, solid.swell.x) * (ORTHOGRAPHIC ? 1 : solid.climb);
    return TileSolid(dot(solid.clip.xy, solid.skew) + (ORTHOGRAPHIC ? 0 : solid.clip.z), solid.skew,
                     vec2(min(ends.x, ends.y), max(ends.x, ends.y)), solid.climb);
}

TileSolid hand_round(TileSolid mine, uint i) {
    return TileSolid(subgroupShuffle(mine.clip_change, i), subgroupShuffle(mine.skew, i), subgroupShuffle(mine.h, i),
                     subgroupShuffle(mine.climb, i));
}

// `at_clip`: past_clip at the pixel.
Meeting meet_close_solid(PixelPlane at, TileSolid solid, float at_clip) {
    Meeting meeting = meet_disk(at);
    // Beyond the plane's horizon e is below 0.
    const float past_clip = at.e < 0 ? -at_clip : at_clip;
    meeting.on_disk = meeting.on_disk && at.e > 0 && past_clip <= 0 && meeting.z <= 1;
    const vec2 q = ORTHOGRAPHIC ? solid.skew : vec2(at.u + solid.skew.x * at.e, at.v + solid.skew.y * at.e);
    const float uq = at.u * q.x + at.v * q.y;
    const float qq = q.x * q.x + q.y * q.y;
    // The part of the solid in front of the near plane: z / (1 + gain) or z - gain climb is at most 1 there.
    const float near_gain = ORTHOGRAPHIC ? (meeting.z - 1) / solid.climb : meeting.z - 1;
    const bool grows = ORTHOGRAPHIC ? solid.climb > 0 : at.e > 0;
    float low = grows ? max(solid.h.x, near_gain) : solid.h.x;
    float high = grows ? solid.h.y : min(solid.h.y, near_gain);
    // And on the side of the clip line that is kept.
    const float clip_change = solid.clip_change * (ORTHOGRAPHIC ? 1 : abs(at.e)) + (ORTHOGRAPHIC ? 0 : past_clip);
    const float clip_gain = -past_clip / clip_change;
    high = clip_change > 0 ? min(high, clip_gain) : high;
    low = clip_change < 0 ? max(low, clip_gain) : low;
    high = clip_change == 0 && past_clip > 0 ? low - 1 : high;
    const float gain = clamp(-uq / max(qq, 1e-30), low, high);
    meeting.beside_disk =
        !meeting.on_disk && low <= high && meeting.distance2 + gain * (2 * uq + gain * qq) <= at.e * at.e;
    const float h = meeting.beside_disk ? gain : 0;
    meeting.share = ORTHOGRAPHIC ? 1 : 1 + h;
    meeting.z -= ORTHOGRAPHIC ? h * solid.climb : 0;
    meeting.nearest += h * q;
    return meeting;
}

// In perspective the gain G changes (u, v) by G ((u, v) + skew e), past_clip likewise, and z by the factor 1 / (1 + G).
// With k = G e / (1 + G), of G above LEAST_GAIN, the solid is met where |(u, v) + k skew| <= e - k and past_clip + k
// clip_change <= 0, at the depth buffer value z (e - k): affine in k, as all of it is in parallel projection.
struct TileAxis {
    vec2 skew;
    float steepness;  // |skew|^2
    vec2 ends;        // least and largest k, over e
    float clip_k;     // k at which past_clip becomes 0, over past_clip
    vec2 clip_ends;   // added to it: what bounds the least and the largest k; where it does not, out of the way
    float climb;      // change of the depth buffer value, less
};

const float NO_BOUND = 1e9;

TileAxis axis_in_tile(TileSolid solid, float z) {
    TileAxis axis;
    axis.skew = solid.skew;
    axis.steepness = max(dot(solid.skew, solid.skew), 1e-30);
    axis.ends = ORTHOGRAPHIC ? solid.h : solid.h / (1 + solid.h);
    const float change = (solid.clip_change < 0 ? -1 : 1) * max(abs(solid.clip_change), 1e-4);
    axis.clip_k = -1 / change;
    axis.clip_ends = change > 0 ? vec2(-NO_BOUND, 0) : vec2(0, NO_BOUND);
    axis.climb = ORTHOGRAPHIC ? solid.climb : z;
    return axis;
}

TileAxis hand_round(TileAxis mine, uint i) {
    return TileAxis(subgroupShuffle(mine.skew, i), subgroupShuffle(mine.steepness, i),
                    subgroupShuffle(mine.ends, i), subgroupShuffle(mine.clip_k, i), subgroupShuffle(mine.clip_ends, i),
                    subgroupShuffle(mine.climb, i));
}

Meeting meet_solid(PixelPlane at, TileAxis axis, float past_clip) {
    const float distance2 = at.u * at.u + at.v * at.v;
    const bool on_disk = distance2 <= at.e * at.e && past_clip <= 0 && at.e > 0;
    const float clip_k = past_clip * axis.clip_k;
    const float low = highest(axis.ends.x * at.e, clip_k + axis.clip_ends.x);
    const float high = lowest(axis.ends.y * at.e, clip_k + axis.clip_ends.y);
    // Where the ray is nearest the axis; in perspective, where |(u, v) (1 + G) + G e skew| is least.
    const float along = at.u * axis.skew.x + at.v * axis.skew.y;
    // With the eye inside the cylinder it is beyond the least.
    const float slope = along + at.e * axis.steepness;
    const float nearest_k = ORTHOGRAPHIC ? -along / axis.steepness
                            : slope > 0  ? -(distance2 + at.e * along) / slope
                                         : -NO_BOUND;
    const float k = lowest(highest(nearest_k, low), high);
    const vec2 nearest = vec2(at.u + k * axis.skew.x, at.v + k * axis.skew.y);
    const float rim = ORTHOGRAPHIC ? 1 : at.e - k;
    const bool beside_disk = !on_disk && low <= high && dot(nearest, nearest) <= rim * rim;
    const float z = ORTHOGRAPHIC ? at.z - (beside_disk ? k * axis.climb : 0) : at.z * (beside_disk ? rim : at.e);
    return Meeting(on_disk, beside_disk, z, 1, beside_disk ? nearest : vec2(at.u, at.v), distance2);
}

#endif
