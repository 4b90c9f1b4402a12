// What a pixel of the picture holds, from the sums over its surfels or from its triangle. Needs frame.glsl,
// colour.glsl.
#ifndef SPLICE_COMPOSE_GLSL
#define SPLICE_COMPOSE_GLSL

// `sum`: (w rgb, w), used where surfels own the pixel.
vec4 composed(vec4 triangles, bool surfels, vec4 sum) {
    if (VIEW == VIEW_OVERLAP) return vec4(surfels ? sum.a : 0, 0, 0, 1);
    const vec3 linear = surfels ? sum.rgb / sum.a : triangles.rgb;
    if (VIEW == VIEW_DEPTH || VIEW == VIEW_NORMALS) return vec4(linear, 1);
    // Half scale: two fully weighted splats reach white's level.
    if (VIEW == VIEW_ACCUMULATION) return vec4(encode_srgb(surfels ? 0.5 * sum.rgb : vec3(0)), 1);
    return vec4(encode_srgb(linear), 1);
}

#endif
