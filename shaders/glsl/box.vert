// The edges of a box, an instance each: two triangles an edge, as wide as a pixel of the picture whichever way it runs.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "frame.glsl"

layout(location = 0) in vec3 in_low;
layout(location = 1) in vec3 in_high;
layout(location = 2) in uint in_level;

layout(location = 0) flat out uint out_level;

// Of an edge's two triangles: the end, and the side.
const vec2 CORNERS[6] = vec2[](vec2(0, -1), vec2(1, -1), vec2(1, 1), vec2(0, -1), vec2(1, 1), vec2(0, 1));

void main() {
    out_level = in_level;
    const uint edge = uint(gl_VertexIndex) / 6;
    const vec2 corner = CORNERS[gl_VertexIndex % 6];
    // Four edges along each axis; the other two axes say which.
    const uint along = edge / 4, first = (along + 1) % 3, second = (along + 2) % 3;
    vec3 near_end = in_low;
    if ((edge & 1) != 0) near_end[first] = in_high[first];
    if ((edge & 2) != 0) near_end[second] = in_high[second];
    vec3 far_end = near_end;
    far_end[along] = in_high[along];

    vec3 a = to_view_space(near_end), b = to_view_space(far_end);
    // What is behind the near plane has no place in the window.
    const float plane = -frame.near_plane;
    if (a.z > plane && b.z > plane) {
        gl_Position = vec4(0, 0, 0, 1);
        return;
    }
    if (a.z > plane) a = mix(a, b, (plane - a.z) / (b.z - a.z));
    if (b.z > plane) b = mix(b, a, (plane - b.z) / (a.z - b.z));
    const vec4 clip_a = frame.projection * vec4(a, 1), clip_b = frame.projection * vec4(b, 1);
    const vec2 run = 0.5 * frame.viewport * (clip_b.xy / clip_b.w - clip_a.xy / clip_a.w);
    const float run_length = length(run);
    const vec2 forth = run_length > 1e-6 ? run / run_length : vec2(1, 0);
    // Beyond their ends by as much as they are wide, so that edges meet.
    const vec2 offset = 0.5 * float(frame.samples_per_side) *
                        ((2 * corner.x - 1) * forth + corner.y * vec2(-forth.y, forth.x));
    gl_Position = corner.x == 0 ? clip_a : clip_b;
    gl_Position.xy += offset / (0.5 * frame.viewport) * gl_Position.w;
}
