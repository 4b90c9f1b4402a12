// Normalisation (thesis 3.4.2): sums over weights where surfels own the pixel, the triangles' colour elsewhere. Drawn
// twice, the stencil value of the visibility pass telling the two apart.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "frame.glsl"
#include "colour.glsl"

layout(constant_id = 0) const bool SURFELS = false;
layout(constant_id = 3) const bool BY_WEIGHT = false;  // drawn once: surfels own the pixel where there is a weight

layout(constant_id = 4) const bool TO_RESOLVE = false;  // linear samples instead of a picture

layout(input_attachment_index = 0, set = 1, binding = 0) uniform subpassInput triangle_colour;
layout(input_attachment_index = 1, set = 1, binding = 1) uniform subpassInput accumulation;
layout(input_attachment_index = 2, set = 1, binding = 2) uniform subpassInput depth;

// Colours: sRGB-encoded, alpha is coverage. Views of numbers (depth, visibility, overlap): the number in red, which
// lands in a float target; visibility is negative where surfels own the pixel.
layout(location = 0) out vec4 out_colour;

void main() {
    const vec4 triangles = subpassLoad(triangle_colour);
    const vec4 sum = subpassLoad(accumulation);
    const bool surfels = BY_WEIGHT ? sum.a > 0 : SURFELS;
    if (!surfels && triangles.a == 0) discard;
    if (VIEW == VIEW_VISIBILITY) {
        const float eye_depth = decode_depth(subpassLoad(depth).r);
        out_colour = vec4(surfels ? -eye_depth : eye_depth, 0, 0, 1);
        return;
    }
    if (VIEW == VIEW_OVERLAP) {
        out_colour = vec4(surfels ? sum.a : 0, 0, 0, 1);
        return;
    }
    const vec3 linear = surfels ? sum.rgb / sum.a : triangles.rgb;
    if (VIEW == VIEW_DEPTH) {
        out_colour = vec4(linear, 1);
    } else if (VIEW == VIEW_NORMALS) {
        out_colour = vec4(TO_RESOLVE ? decode_srgb(linear) : linear, 1);  // numbers, not light
    } else {
        // Half scale: two fully weighted splats reach white's level.
        const vec3 light = VIEW == VIEW_ACCUMULATION ? (surfels ? 0.5 * sum.rgb : vec3(0)) : linear;
        out_colour = vec4(TO_RESOLVE ? light : encode_srgb(light), 1);
    }
}
