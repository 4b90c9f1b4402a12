// Triangle patches, lit per pixel.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "frame.glsl"
#include "octahedral.glsl"
#include "colour.glsl"

layout(location = 0) in vec3 in_position;
layout(location = 1) in vec2 in_normal;  // octahedral
layout(location = 2) in vec4 in_colour;  // sRGB-encoded
layout(location = 3) in vec2 in_uv;

layout(location = 0) out vec3 out_position;
layout(location = 1) out vec3 out_normal;
layout(location = 2) out vec3 out_colour;
layout(location = 3) out vec2 out_uv;
layout(location = 4) flat out uint out_patch;

void main() {
    out_position = to_view_space(in_position);
    out_normal = normal_to_view_space(decode_octahedral(in_normal));
    out_colour = decode_srgb(in_colour.rgb);
    out_uv = in_uv;
    out_patch = gl_InstanceIndex;  // the draw's first instance
    gl_Position = frame.projection * vec4(out_position, 1);
}
