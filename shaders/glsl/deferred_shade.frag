// Normalisation of deferred shading (Botsch et al. 2005): where surfels own the pixel, the mean normal and albedo are
// lit; elsewhere the triangles' colour. Drawn as surfel_normalise.frag is.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "frame.glsl"
#include "colour.glsl"
#include "lighting.glsl"

layout(constant_id = 0) const bool SURFELS = false;
layout(constant_id = 3) const bool BY_WEIGHT = false;   // drawn once: surfels own the pixel where there is a weight
layout(constant_id = 4) const bool TO_RESOLVE = false;  // linear samples instead of a picture

layout(input_attachment_index = 0, set = 1, binding = 0) uniform subpassInput triangle_colour;
layout(input_attachment_index = 1, set = 1, binding = 1) uniform subpassInput albedo_sum;
layout(input_attachment_index = 2, set = 1, binding = 2) uniform subpassInput normal_sum;

layout(location = 0) out vec4 out_colour;  // sRGB-encoded, alpha is coverage

void main() {
    const vec4 triangles = subpassLoad(triangle_colour);
    const vec4 albedo = subpassLoad(albedo_sum);
    const bool surfels = BY_WEIGHT ? albedo.a > 0 : SURFELS;
    if (!surfels && triangles.a == 0) discard;
    vec3 light = triangles.rgb;
    if (surfels) {
        const vec4 normal = subpassLoad(normal_sum) / albedo.a;
        const vec3 position = from_window(gl_FragCoord.xy, decode_depth(normal.w));
        light = shade(albedo.rgb / albedo.a, normal.xyz * inversesqrt(max(dot(normal.xyz, normal.xyz), 1e-20)),
                      position);
    }
    out_colour = vec4(TO_RESOLVE ? light : encode_srgb(light), 1);
}
