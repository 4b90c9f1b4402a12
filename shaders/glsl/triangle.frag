#version 460
#extension GL_GOOGLE_include_directive : require
#include "frame.glsl"
#include "colour.glsl"
#include "lighting.glsl"
#include "compose.glsl"

layout(constant_id = 0) const bool WIRES = false;
layout(constant_id = 3) const bool TO_PICTURE = false;

layout(location = 0) in vec3 in_position;
layout(location = 1) in vec3 in_normal;
layout(location = 2) in vec3 in_colour;
layout(location = 3) in vec2 in_uv;
layout(location = 4) flat in uint in_patch;

layout(set = 1, binding = 0) uniform sampler2D diffuse;  // white where a material has no image

layout(location = 0) out vec4 out_colour;  // linear, or as the picture holds it; alpha is coverage

vec4 finished(vec3 colour) {
    return TO_PICTURE ? composed(vec4(colour, 1), false, vec4(0), false) : vec4(colour, 1);
}

void main() {
    const vec3 texel = texture(diffuse, in_uv).rgb;  // its derivatives are taken before the control flow parts
    if (WIRES) {
        out_colour = finished(vec3(0.01, 0.02, 0.05));
        return;
    }
    if (VIEW == VIEW_DEPTH) {
        out_colour = finished(vec3(-in_position.z));
        return;
    }
    const vec3 normal = face_the_eye(normalize(in_normal), in_position);
    out_colour = finished(view_colour(in_colour * texel, normal, in_position, in_patch, false));
}
