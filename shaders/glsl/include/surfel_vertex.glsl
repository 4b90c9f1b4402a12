// Vertex stage of both surfel passes: a record of the model file in, a splat and the primitive around it out. As a
// point sprite the vertex is the surfel; as a quad (too large for a point, or centred off the screen) four vertices an
// instance span the footprint's bounds. Needs frame.glsl, octahedral.glsl, splat.glsl.
#ifndef SPLICE_SURFEL_VERTEX_GLSL
#define SPLICE_SURFEL_VERTEX_GLSL

layout(constant_id = 0) const bool AS_QUADS = false;

layout(location = 0) in vec3 in_position;
layout(location = 1) in float in_radius;
layout(location = 2) in vec2 in_normal;   // octahedral
layout(location = 3) in vec4 in_colour;   // sRGB-encoded
layout(location = 4) in float in_bend_0;  // format::Surfel::shading_bend, 1 for the largest
layout(location = 5) in uint in_patch;
layout(location = 6) in vec4 in_bend_1_4;
layout(location = 7) in uint in_extent;  // preprocess/model_format/surfel_extent.h

const float SLACK_PX = 0.05;  // rasterisers snap positions to 1/256 pixel or so

// The same surfels whatever else is drawn with them.
bool in_sample(vec3 position) {
    uint h = floatBitsToUint(position.x) * 0x9e3779b9u;
    h = (h ^ floatBitsToUint(position.y) ^ (h >> 15)) * 0x9e3779b9u;
    h = (h ^ floatBitsToUint(position.z) ^ (h >> 15)) * 0x9e3779b9u;
    h ^= h >> 16;
    h *= 0x85ebca6bu;
    h ^= h >> 13;
    return float(h >> 8) < frame.sample_share * 16777216.0;
}

struct SurfelFrame {
    vec3 centre, normal, s, t;  // view space; s and t as format::Surfel::shading_bend means them
    float radius;               // world units
};

// kSwellStep, kSwellStep, kEpsilonStep; kSwellOne, kSwellOne, kEpsilonOne
const vec3 EXTENT_POWERS = vec3(0.4, 0.4, 0.25);
const vec3 EXTENT_ONES = vec3(31, 31, 24);

// The splat of this vertex's surfel; false if it is not to be drawn.
bool surfel_splat(out Splat splat, out SurfelFrame surfel) {
    const vec3 centre = surfel.centre = to_view_space(in_position);
    const vec3 model_normal = decode_octahedral(in_normal);
    const vec3 normal = surfel.normal = normal_to_view_space(model_normal);
    tangents_of(model_normal, surfel.s, surfel.t);
    surfel.s = normal_to_view_space(surfel.s);
    surfel.t = normal_to_view_space(surfel.t);
    const bool two_sided = (instance.flags & INSTANCE_TWO_SIDED) != 0;
    if (!two_sided && beyond_horizon(normal, centre)) return false;
    const float baked_radius = in_radius * instance.scale;
    float radius = baked_radius;
    if (VIEW == VIEW_SAMPLES) {
        if (!in_sample(in_position)) return false;
        radius *= frame.sample_radius;
    }
    surfel.radius = radius;
    const uvec3 steps = uvec3(in_extent & 31, in_extent >> 5 & 31, in_extent >> 10);
    const vec3 shares = mix(exp2(EXTENT_POWERS * (vec3(steps) - EXTENT_ONES)), vec3(0), equal(steps, uvec3(0)));
    return make_splat(centre, normal, surfel.s, surfel.t, radius, VIEW == VIEW_SAMPLES ? vec2(0) : shares.xy,
                      shares.z * baked_radius * instance.epsilon_scale, splat);
}

// Places this vertex so that the primitive covers every pixel of `bounds` and the one that holds the centre.
void place_primitive(bool drawn, vec2 anchor, vec4 bounds) {
    gl_PointSize = 1;
    gl_Position = vec4(2, 2, 2, 1);  // clipped
    if (!drawn) return;
    vec2 window = anchor;
    if (AS_QUADS) {
        const vec2 low = max(min(bounds.xy, floor(anchor)) - SLACK_PX, vec2(-1));
        const vec2 high = min(max(bounds.zw, floor(anchor) + 1) + SLACK_PX, frame.viewport + 1);
        if (any(greaterThanEqual(low, high))) return;
        window = vec2((gl_VertexIndex & 1) != 0 ? high.x : low.x, (gl_VertexIndex & 2) != 0 ? high.y : low.y);
    } else {
        const vec2 reach = max(anchor - bounds.xy, bounds.zw - anchor);
        gl_PointSize = max(2 * (max(reach.x, reach.y) + SLACK_PX), 1 + 2 * SLACK_PX);
    }
    gl_Position = vec4(window / frame.viewport * 2 - 1, 0.5, 1);
}

#endif
