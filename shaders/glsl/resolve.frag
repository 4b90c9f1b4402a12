// Several samples a pixel become one: their mean in linear light, over the background where not all are covered.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "frame.glsl"
#include "colour.glsl"

layout(set = 1, binding = 0) uniform sampler2D samples;  // linear; alpha 1 where a surface is, else 0

layout(location = 0) out vec4 out_colour;  // sRGB-encoded; alpha is coverage

void main() {
    const int side = int(frame.samples_per_side);
    const ivec2 corner = ivec2(gl_FragCoord.xy) * side;
    vec4 sum = vec4(0);
    for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x) sum += texelFetch(samples, corner + ivec2(x, y), 0);
    if (sum.a == 0) discard;  // the background as it is
    const float count = float(side * side);
    const vec3 colour =
        frame.background.a > 0 ? (sum.rgb + (count - sum.a) * frame.background.rgb) / count : sum.rgb / sum.a;
    out_colour = vec4(encode_srgb(colour), sum.a / count);
}
