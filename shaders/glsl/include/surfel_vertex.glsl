// Vertex stage of both surfel passes: a record of the model file in, a splat and the primitive around it out. As a
// point sprite the vertex is the surfel; as a quad (too large for a point, or centred off the screen) four vertices an
// instance span the footprint's bounds. Needs surfel_frame.glsl.
#ifndef SPLICE_SURFEL_VERTEX_GLSL
#define SPLICE_SURFEL_VERTEX_GLSL

layout(constant_id = 0) const bool AS_QUADS = false;

layout(location = 0) in uvec4 in_first;   // surfel_record.glsl
layout(location = 1) in uvec4 in_second;

const float SLACK_PX = 0.05;  // rasterisers snap positions to 1/256 pixel or so

SurfelRecord vertex_record() {
    const uint index = instance.first_surfel + (AS_QUADS ? gl_InstanceIndex : gl_VertexIndex);
    return decode_surfel(in_first, in_second, index);
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
