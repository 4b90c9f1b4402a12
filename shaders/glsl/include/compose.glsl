// What a pixel of the picture holds, from the sums over its surfels or from its triangle. Needs frame.glsl,
// colour.glsl.
#ifndef SPLICE_COMPOSE_GLSL
#define SPLICE_COMPOSE_GLSL

// `sum`: (w rgb, w), used where surfels own the pixel. `linear_samples`: light, for the resolve pass, instead of sRGB.
vec4 composed(vec4 triangles, bool surfels, vec4 sum, bool linear_samples) {
    if (VIEW == VIEW_OVERLAP) return vec4(surfels ? sum.a : 0, 0, 0, 1);
    const vec3 linear = surfels ? sum.rgb / sum.a : triangles.rgb;
    if (VIEW == VIEW_DEPTH) return vec4(linear, 1);
    if (VIEW == VIEW_NORMALS) return vec4(linear_samples ? decode_srgb(linear) : linear, 1);  // numbers, not light
    // Half scale: two fully weighted splats reach white's level.
    const vec3 light = VIEW == VIEW_ACCUMULATION ? (surfels ? 0.5 * sum.rgb : vec3(0)) : linear;
    return vec4(linear_samples ? light : encode_srgb(light), 1);
}

#endif
