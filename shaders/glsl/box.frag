// Edges of boxes in the colour of their level, unlit.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "frame.glsl"
#include "colour.glsl"

layout(constant_id = 4) const bool TO_RESOLVE = false;  // linear samples instead of a picture

layout(location = 0) flat in uint in_level;

layout(location = 0) out vec4 out_colour;

void main() {
    const vec3 colour = level_colour(in_level);
    out_colour = vec4(TO_RESOLVE ? colour : encode_srgb(colour), 1);
}
