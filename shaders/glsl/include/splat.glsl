// From a surfel to its footprint on screen, and from a pixel back to the surfel: shared by the visibility and the
// attribute pass, so that both cover the same pixels and measure the same depths.
//
// The ray of the pixel at offset d (pixels) from the projection of an anchor point P of the surfel's plane meets the
// plane at the disk coordinates (u, v), in radii, and at the depth t:
//   perspective   e = 1 + g.d,  (u, v) = a + A d / e,  t = t_P / e
//   orthographic  e = 1,        (u, v) = a + A d,      t = t_P - g.d
// which is the ray-plane intersection of Botsch et al. (thesis 3.4.2, figure 3.8) with everything that does not depend
// on the pixel moved to the vertex stage, and, being relative to P, without its cancellation far from the origin.
// P is the centre (a = 0) unless the disk crosses the near plane; then P is the disk's farthest point (|a| = 1), which
// projects safely.
//
// A flat disk stands for a piece of surface that is not flat. The part of the cylinder over the disk between `below`
// and `above` its plane (preprocess/model_format/surfel_extent.h) holds all of that piece, and every piece of the
// surface has its disk. So a ray that meets the surface meets one of these solids, even where it slips between two
// disks that are tilted against each other: no holes, from any side. A solid that is met beside its disk shows only
// where no disk does. Needs frame.glsl.
#ifndef SPLICE_SPLAT_GLSL
#define SPLICE_SPLAT_GLSL

struct Splat {
    vec2 anchor;        // window position of P
    vec4 plane_map;     // A, column by column
    vec2 g;
    float anchor_depth; // t_P
    vec2 plane_offset;  // a
    vec3 skew;          // how (u, v) and t change along the ray, a radius along the normal; see skew_at
    vec4 clip;          // the line that cuts the disk; see clip_line
    vec2 swell;         // how far the solid reaches above and below the plane, in radii
    float rise;         // the disk's depths are within this of t_P
    float epsilon;      // by how much the visibility pass moves depth away, along the ray, world units
    vec3 conic;         // V^-1: xx, xy, yy; V the resampling covariance, thesis 3.22
    float weight;       // of the splat's centre, in (0, 1]
    vec4 disk_bounds;   // window pixels: minimum, maximum of the disk
    vec4 splat_bounds;  // the same of the EWA footprint, disk included
};

// Disks narrower than this show at the pixel that holds their centre even when they miss its sample. Wider ones cover
// samples as triangles do: shown at every pixel they touch, they would grow each outline by up to half a pixel (3.5 dB
// on the thesis's dragon), and a hole-free cover does not need it.
const float SPECK = 0.25;  // pixels

// Whether the projected disk is a speck, wide and high.
bool is_sub_pixel(Splat splat) {
    return all(lessThan(splat.disk_bounds.zw - splat.disk_bounds.xy, vec2(SPECK)));
}

// At grazing angles neighbouring disks, tilted against each other, disagree along the ray by more than the baked
// epsilon, which bounds how far they are apart across the surface. Two disks tilted by TILT disagree by at most
// epsilon * TILT perpendicular to the surface (point-and-edge, equation 8), along the ray by that over the cosine of
// the viewing angle; beyond MAX_STRETCH, hidden surfaces would begin to shine through.
const float TILT = 0.3;
const float MAX_STRETCH = 3.0;
// Edge-on planes are hit nowhere; keeps the divisions finite.
const float MIN_COSINE = 1e-4;
const float MIN_WEIGHT = 1.0 / 4096.0;
// Variance of the prefilter, pixels^2. The thesis's 1 (3.22) blurs more than a pixel's box (variance 1/12) does: 0.3 is
// the least that lets every splat reach a pixel centre, its footprint ending at sqrt(2 * 0.3) > sqrt(2) / 2 pixels.
const float PREFILTER = 0.3;
const float PREFILTER_REACH = 2;  // pixels by which a splat or a speck's pixel exceeds the disk, and some
const float NOWHERE = 1e18;

// engine/scene/kernel.h. The default is a Gaussian of variance 1/2, cut at the rim.
layout(constant_id = 20) const uint KERNEL = 0;
layout(constant_id = 21) const float KERNEL_SUPPORT = 1;
layout(constant_id = 22) const float KERNEL_MOMENT = 0.5;
layout(constant_id = 23) const float KERNEL_A = 0;
layout(constant_id = 24) const float KERNEL_N = 0;
const uint KERNEL_DISK = 0;
const uint KERNEL_GAUSSIAN = 1;
const uint KERNEL_CONFETTI = 2;
#define KERNEL_SUPPORT2 (KERNEL_SUPPORT * KERNEL_SUPPORT)

// At a squared distance from the centre, in radii, of another kernel than the default.
float other_kernel(float distance2) {
    if (KERNEL == KERNEL_GAUSSIAN) return exp(-KERNEL_A * distance2);
    if (KERNEL != KERNEL_CONFETTI) return 1;
    const float share = min(pow(distance2 / KERNEL_SUPPORT2, 0.5 * KERNEL_N), 0.999);
    // A pixel that no heavier splat reaches still needs a weight.
    return max(exp(-KERNEL_A * share / (1 - share)), 1e-6);
}

// preprocess/model_format/tangent_frame.h computes the same.
void tangents_of(vec3 n, out vec3 s, out vec3 t) {
    // Duff et al. 2017, "Building an orthonormal basis, revisited".
    const float side = n.z >= 0 ? 1.0 : -1.0;
    const float a = -1 / (side + n.z);
    const float b = n.x * n.y * a;
    s = vec3(1 + side * n.x * n.x * a, side * b, -side * n.x);
    t = vec3(b, side + n.y * n.y * a, -n.y);
}

vec2 project_to_window(vec3 p) {
    const vec2 q = ORTHOGRAPHIC ? p.xy : p.xy / -p.z;
    return frame.viewport * 0.5 + frame.pixel_scale * vec2(q.x, -q.y);
}

// Extremes over the disk of the image coordinate (c + r (s cos + t sin)) / (depth of the same), the roots k of
// |r (s - k s_d, t - k t_d)| = |c - k d|. `c`, `s`, `t`: one coordinate of centre and tangents; `d`, `sd`, `td`:
// depths.
vec2 projected_extremes(float c, float s, float t, float d, float sd, float td, float r) {
    const float r2 = r * r;
    const float qa = d * d - r2 * (sd * sd + td * td);
    const float qb = c * d - r2 * (s * sd + t * td);
    const float qc = c * c - r2 * (s * s + t * t);
    const float root = sqrt(max(qb * qb - qa * qc, 0));
    return vec2(qb - root, qb + root) / qa;
}

const vec3 NO_CLIP = vec3(0, 0, 1);
// A cut ends where triangles begin, whose corners the rasteriser moves by up to half a 256th of a pixel: a cut reaches
// a hair farther, or the pixels whose centres lie in between would show neither.
const float CLIP_SLACK = 1.0 / 128.0;  // pixels

// The disk is kept where clip.xy . (u, v) <= clip.z; times e, that is l.d + l0 <= 0. Returns l, l0 and what the change
// of that a radius along the normal takes.
vec4 clip_line(vec3 clip, Splat splat) {
    vec2 l = vec2(dot(clip.xy, splat.plane_map.xy), dot(clip.xy, splat.plane_map.zw));
    const float l0 = dot(clip.xy, splat.plane_offset) - clip.z;
    const float skewed = dot(clip.xy, splat.skew.xy);
    if (!ORTHOGRAPHIC) l += l0 * splat.g;
    return vec4(l, l0 - CLIP_SLACK * length(l), ORTHOGRAPHIC ? skewed : clip.z + skewed);
}

// Software devices compute both sides of a branch, and carry each value that either writes through memory: so there are
// no branches, nor early ends, but choices between values.
//
// `centre`, unit `normal` and its tangents `s`, `t` in view space, `radius` along s and `epsilon` in world units; the
// half axis along t is `ratio` of it, 1 for a disk. False: nothing of it can be seen.
bool make_splat(vec3 centre, vec3 normal, vec3 s, vec3 t, float radius, float ratio, vec2 swell, vec3 clip,
                float epsilon, out Splat splat) {
    // From here on s and t are the half axes in units of the radius, and v is what to_v measures.
    const vec3 to_v = t / ratio;
    t *= ratio;
    const float depth = -centre.z;
    const vec2 slope = vec2(-s.z, -t.z);  // change of depth along the tangents
    const float steepness = length(slope);
    const float thickness = radius * max(swell.x, swell.y);
    splat.swell = swell;
    splat.rise = radius * steepness + thickness * abs(normal.z);
    const bool nearer = depth + splat.rise <= frame.near_plane;
    const bool crosses_near = depth - splat.rise < frame.near_plane;

    // A disk that faces the eye crosses by its thickness alone.
    splat.plane_offset = crosses_near && steepness > 0 ? slope / steepness : vec2(0);
    const vec3 p = centre + radius * (splat.plane_offset.x * s + splat.plane_offset.y * t);
    splat.rise *= crosses_near ? 2 : 1;
    splat.anchor_depth = -p.z;
    // Only the thickness reaches past the near plane, over the eye's head.
    const bool overhead = crosses_near && splat.anchor_depth <= 0;
    const vec3 ray = ORTHOGRAPHIC ? vec3(0, 0, -1) : vec3(p.xy / splat.anchor_depth, -1);
    float facing = dot(normal, ray);
    facing = abs(facing) < MIN_COSINE ? (facing < 0 ? -MIN_COSINE : MIN_COSINE) : facing;
    const vec3 dx = vec3(1 / frame.pixel_scale, 0, 0), dy = vec3(0, -1 / frame.pixel_scale, 0);
    splat.g = vec2(dot(normal, dx), dot(normal, dy)) / facing;
    const float reach = (ORTHOGRAPHIC ? 1 : splat.anchor_depth) / radius;
    const vec3 along_x = (dx - splat.g.x * ray) * reach, along_y = (dy - splat.g.y * ray) * reach;
    splat.anchor = project_to_window(p);
    splat.plane_map = vec4(dot(s, along_x), dot(to_v, along_x), dot(s, along_y), dot(to_v, along_y));
    const vec3 off_axis = ORTHOGRAPHIC ? ray / facing : centre / radius;
    splat.skew = vec3(dot(s, off_axis), dot(to_v, off_axis), radius / facing);
    splat.clip = clip_line(clip, splat);
    splat.epsilon = epsilon * clamp(TILT * length(ray) / abs(facing), 1, MAX_STRETCH);

    // Rows of J times the radius: how the window position changes along the tangents.
    const float eta = frame.pixel_scale * radius;
    vec2 jx, jy;
    if (ORTHOGRAPHIC) {
        jx = eta * vec2(s.x, t.x);
        jy = -eta * vec2(s.y, t.y);
        const vec2 extent = vec2(length(jx), length(jy)) + frame.pixel_scale * thickness * abs(normal.xy);
        splat.disk_bounds = vec4(splat.anchor - extent, splat.anchor + extent);
    } else {
        jx = eta / depth * (vec2(s.x, t.x) - slope * (centre.x / depth));
        jy = -eta / depth * (vec2(s.y, t.y) - slope * (centre.y / depth));
        const vec2 x = projected_extremes(centre.x, s.x, t.x, depth, slope.x, slope.y, radius);
        const vec2 y = projected_extremes(-centre.y, -s.y, -t.y, depth, slope.x, slope.y, radius);
        // A point at (x, y) in the image that moves by h along the normal moves there by h (n - n_z (x, y)) / depth.
        const vec2 farthest = max(abs(vec2(x.x, y.x)), abs(vec2(x.y, y.y)));
        const vec2 faces = thickness / (depth - splat.rise) * (abs(normal.xy) + abs(normal.z) * farthest);
        splat.disk_bounds =
            frame.viewport.xyxy * 0.5 + frame.pixel_scale * (vec4(x.x, y.x, x.y, y.y) + vec4(-faces, faces));
    }
    // At the near plane no affine approximation holds; the exact disk alone decides, wherever on the screen that is.
    splat.disk_bounds = crosses_near ? vec4(0, 0, frame.viewport) : splat.disk_bounds;
    const bool exact = crosses_near || (frame.prefilter == 0 && KERNEL_SUPPORT <= 1);
    // V = J V_r J^T + I with V_r = r^2 / 2, cut where x^T V^-1 x / 2 = 1; of other kernels with their moment and
    // support.
    const float filtered = frame.prefilter == 0 ? 1e-4 : PREFILTER;
    const vec3 v = vec3(dot(jx, jx), dot(jx, jy), dot(jy, jy)) * KERNEL_MOMENT + filtered * vec3(1, 0, 1);
    const float determinant = v.x * v.z - v.y * v.y;
    splat.conic = exact ? vec3(NOWHERE, 0, NOWHERE) : vec3(v.z, -v.y, v.x) / determinant;
    // A Gaussian of height 1 on the surface, filtered by the pixel's of volume 1: sqrt(|J V_r J^T| / |V|). Splats
    // smaller than a pixel count by the area they cover.
    splat.weight =
        exact ? 1 : max(KERNEL_MOMENT * abs(jx.x * jy.y - jx.y * jy.x) * inversesqrt(determinant), MIN_WEIGHT);
    const vec2 extent = sqrt(KERNEL_SUPPORT2 / KERNEL_MOMENT * vec2(v.x, v.z));
    splat.splat_bounds = exact ? splat.disk_bounds
                               : vec4(min(splat.disk_bounds.xy, splat.anchor - extent),
                                      max(splat.disk_bounds.zw, splat.anchor + extent));
    return !(nearer || overhead);
}

// A flag in the sign of a number that is not negative, which saves the fragments an input.
float flagged(float value, bool flag) { return flag ? -max(value, 1e-30) : value; }

struct SplatHit {
    bool on_disk;      // the ray meets the disk, or the pixel holds the centre of a disk between pixel centres
    bool beside_disk;  // it does not, but meets the solid
    bool cut_off;      // it meets the plane where the line cut the disk off, more than half a pixel beyond
    float depth;       // of the plane there, or of that centre, or of where the ray is nearest the solid's axis
    float distance2;   // squared distance from the centre in radii, where the ray meets the disk; else NOWHERE
    vec2 uv;           // where the ray meets the plane, in radii, or is nearest the solid's axis
    float plane_depth; // of the plane, whatever is met
    vec2 plane_uv;
};

// How (u, v) e changes along the pixel's ray, a radius along the normal; t e changes by skew.z. In perspective skew.xy
// is where the centre lies along the tangents, in radii, seen from the eye.
vec2 skew_at(vec3 skew, vec2 uv, float e, float anchor_depth) {
    return ORTHOGRAPHIC ? skew.xy : (uv + skew.xy * e) * (skew.z / anchor_depth);
}

// A speck that its own pixel's ray misses shows there all the same, else what is behind would bleed through.
SplatHit cast_ray(vec2 pixel, vec2 anchor, vec4 plane_map, vec2 g, float anchor_depth, vec2 plane_offset, vec3 skew,
                  vec2 swell, vec4 clip, bool sub_pixel) {
    const vec2 d = pixel - anchor;
    const float gd = dot(g, d);
    const float e = ORTHOGRAPHIC ? 1 : 1 + gd;
    const vec2 uv = plane_map.xy * d.x + plane_map.zw * d.y + plane_offset * e;
    const float distance2 = dot(uv, uv);
    SplatHit hit;
    hit.depth = ORTHOGRAPHIC ? anchor_depth - gd : (e > 0 ? anchor_depth / e : NOWHERE);
    hit.uv = e > 0 ? uv / e : vec2(0);
    hit.plane_depth = hit.depth;
    hit.plane_uv = hit.uv;
    // Times |e|; beyond the plane's horizon e is below 0.
    const float side = e < 0 ? -1 : 1;
    const float past_clip = side * (dot(clip.xy, d) + clip.z);
    hit.on_disk = e > 0 && distance2 <= e * e && past_clip <= 0 && hit.depth >= frame.near_plane;
    hit.distance2 = hit.on_disk ? distance2 / (e * e) : NOWHERE;
    if (!hit.on_disk && sub_pixel && floor(pixel) == floor(anchor)) {
        hit.on_disk = true;
        hit.depth = anchor_depth;
        hit.uv = vec2(0);
    }
    hit.cut_off = past_clip > 0 && past_clip * past_clip > 0.25 * dot(clip.xy, clip.xy);
    hit.beside_disk = false;
    if (!hit.on_disk) {
        const vec2 change = skew_at(skew, uv, e, anchor_depth);
        const float plane_depth = ORTHOGRAPHIC ? anchor_depth - gd : anchor_depth;  // times e
        // The part of the solid in front of the near plane.
        const float near_height = (frame.near_plane * e - plane_depth) / skew.z;
        float low = e * skew.z > 0 ? max(-swell.y, near_height) : -swell.y;
        float high = e * skew.z > 0 ? swell.x : min(swell.x, near_height);
        // And on the side of the line that is kept.
        const float clip_change = ORTHOGRAPHIC ? clip.w : (past_clip + clip.w * abs(e)) * (skew.z / anchor_depth);
        const float clip_height = -past_clip / clip_change;
        if (clip_change > 0) high = min(high, clip_height);
        if (clip_change < 0) low = max(low, clip_height);
        if (clip_change == 0 && past_clip > 0) high = low - 1;
        const float height = clamp(-dot(uv, change) / max(dot(change, change), 1e-30), low, high);
        const vec2 nearest = uv + height * change;
        hit.beside_disk = low <= high && dot(nearest, nearest) <= e * e;
        if (hit.beside_disk) {
            hit.depth = (plane_depth + height * skew.z) / e;
            hit.uv = nearest / e;
        }
    }
    return hit;
}

// What is met beside a disk moves away this many times as far as a disk, and weighs this much less, so that disks
// decide wherever there are any.
const float BESIDE_PUSH = 4;
const float BESIDE_WEIGHT = 1.0 / 4096;

// Depth moved away from the eye along the pixel's ray by `epsilon`.
float push_back(float depth, float epsilon, vec2 pixel) {
    if (ORTHOGRAPHIC) return depth + epsilon;
    return depth + epsilon * inversesqrt(1 + dot(pixel - frame.viewport * 0.5, pixel - frame.viewport * 0.5) /
                                                 (frame.pixel_scale * frame.pixel_scale));
}

#endif
