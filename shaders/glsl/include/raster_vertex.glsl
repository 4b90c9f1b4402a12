// Vertex stage of the raster backend: three vertices a splat of the list, around all that it may reach. Needs
// frame.glsl, octahedral.glsl, colour.glsl, lighting.glsl, splat.glsl, surfel_frame.glsl, tile.glsl, splat_record.glsl,
// recorded_splat.glsl.
#ifndef SPLICE_RASTER_VERTEX_GLSL
#define SPLICE_RASTER_VERTEX_GLSL

layout(set = 2, binding = 9) uniform usamplerBuffer list_texels;

const float RASTER_SLACK = 0.05;  // pixels; rasterisers snap positions to 1/256 pixel or so
// Where the disk comes nearer to the horizon of its plane than this, its outline is no affine image of a circle.
const float MOST_BENT = 0.7;

uint listed_slot() { return texelFetch(list_texels, int(tiles.first_listed) + gl_VertexIndex / 3).x; }

// Radius of a disk in the splat's plane that hides, from the eye, its solid; 0: none does. A face at the height h is
// seen where (u, v) (1 + t) + t skew is within a radius, t what h gains (tile_gather.comp).
float hiding_radius(Splat splat) {
    float radius = max(KERNEL_SUPPORT, 1);
    const float steepness = length(splat.skew.xy);
    const vec2 ends = vec2(-splat.swell.y, splat.swell.x) * (ORTHOGRAPHIC ? 1 : splat.skew.z / splat.anchor_depth);
    for (int i = 0; i < 2; ++i) {
        const float nearness = ORTHOGRAPHIC ? 1 : 1 + ends[i];
        if (nearness < 0.1) return 0;
        radius = max(radius, (1 + abs(ends[i]) * steepness) / nearness);
    }
    return radius;
}

// The image of a disk of radius r about the anchor, (u, v) <= r, e = 1 + g.d > 0, lies within the image of the circle
// of radius r / (1 - r |h|) under the map B from the plane to the window that is right at the anchor, h = B^T g; with
// `variance` added to B B^T, all the more so.
void place_corner(RecordedSplat recorded, float variance) {
    const Splat splat = recorded.splat;
    const int corner = gl_VertexIndex % 3;
    const vec2 low = max(splat.anchor - recorded.reach - RASTER_SLACK, vec2(-1));
    const vec2 high = min(splat.anchor + recorded.reach + RASTER_SLACK, frame.viewport + 1);
    gl_Position = vec4(2, 2, 2, 1);  // clipped
    if (any(greaterThanEqual(low, high))) return;
    vec2 window = vec2(corner == 1 ? 2 * high.x - low.x : low.x, corner == 2 ? 2 * high.y - low.y : low.y);

    const vec4 a = splat.plane_map;
    const float determinant = a.x * a.w - a.y * a.z;
    const vec2 along_u = vec2(a.w, -a.y) / determinant, along_v = vec2(-a.z, a.x) / determinant;
    const float bent =
        ORTHOGRAPHIC ? 0 : hiding_radius(splat) * length(vec2(dot(along_u, splat.g), dot(along_v, splat.g)));
    const float radius = hiding_radius(splat) / (1 - bent);
    // B B^T with the variance, and its factor L L^T.
    const vec3 spread = vec3(along_u.x * along_u.x + along_v.x * along_v.x,
                             along_u.x * along_u.y + along_v.x * along_v.y,
                             along_u.y * along_u.y + along_v.y * along_v.y) +
                        variance * vec3(1, 0, 1);
    const float l_x = sqrt(spread.x), l_xy = spread.y / l_x, l_y = sqrt(max(spread.z - l_xy * l_xy, 0));
    // The slack, at the narrowest.
    const float grown = radius * (1 + RASTER_SLACK * sqrt(spread.x + spread.z) / (l_x * l_y));
    const bool affine = (recorded.marks & (MARK_SPECK | MARK_NEAR)) == 0 && radius > 0 && bent < MOST_BENT;
    // Of a triangle around the unit circle, over that of the bounds.
    if (affine && 5.2 * grown * grown * l_x * l_y < 2 * (high.x - low.x) * (high.y - low.y)) {
        const vec2 at = corner == 0 ? vec2(0, 2) : vec2(corner == 1 ? -1.7320508 : 1.7320508, -1);
        window = splat.anchor + grown * vec2(l_x * at.x, l_xy * at.x + l_y * at.y);
    }
    gl_Position = vec4(window / frame.viewport * 2 - 1, 0.5, 1);
}

// Pixels^2: twice the prefilter's, for the footprint ends where x^T V^-1 x / 2 is 1; and a little against degenerate
// disks.
float footprint_variance() { return frame.prefilter != 0 ? 2 * PREFILTER : 0.01; }

#endif
