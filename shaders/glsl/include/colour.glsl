// Colour is stored sRGB-encoded, shaded and blended linear (IEC 61966-2-1).
#ifndef SPLICE_COLOUR_GLSL
#define SPLICE_COLOUR_GLSL

vec3 decode_srgb(vec3 c) {
    return mix(c / 12.92, pow((c + 0.055) / 1.055, vec3(2.4)), greaterThan(c, vec3(0.04045)));
}

vec3 encode_srgb(vec3 c) {
    c = clamp(c, 0, 1);
    return mix(c * 12.92, 1.055 * pow(c, vec3(1 / 2.4)) - 0.055, greaterThan(c, vec3(0.0031308)));
}

// A well spread, never dark colour for a number (linear).
vec3 label_colour(uint number) {
    uint h = number * 2654435769u;
    h ^= h >> 15;
    h *= 2246822519u;
    h ^= h >> 13;
    const float hue = float(h & 0xffffu) / 65536.0;
    const float value = 0.65 + 0.35 * float((h >> 16) & 0xffu) / 255.0;
    const float saturation = 0.45 + 0.35 * float(h >> 24) / 255.0;
    const vec3 ramp = clamp(abs(fract(hue + vec3(0, 2.0 / 3.0, 1.0 / 3.0)) * 6 - 3) - 1, 0, 1);
    return decode_srgb(value * mix(vec3(1), ramp, saturation));
}

// A hue of six in turn, so that neighbouring levels differ; 0 is grey, full detail (linear).
vec3 level_colour(uint level) {
    if (level == 0) return vec3(0.6);
    const vec3 ramp = clamp(abs(fract(float(level) / 6 + vec3(0, 2.0 / 3.0, 1.0 / 3.0)) * 6 - 3) - 1, 0, 1);
    return decode_srgb(mix(vec3(0.9), ramp, 0.7));
}

// Of level_label() in engine/scene/draw_list.h: of a node's triangles its hue, the paler the coarser; of a patch's
// grey, the browner the coarser (linear).
vec3 triangle_level_colour(uint label) {
    const uint depth = label & 0xffu;
    const float fineness = pow(0.6, float(label >> 8));
    return depth == 0 ? mix(vec3(0.3, 0.11, 0.03), level_colour(0), fineness)
                      : mix(vec3(0.9), level_colour(depth), fineness);
}

#endif
