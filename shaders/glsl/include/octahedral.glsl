// Unit vectors from the octahedral map, two 16-bit snorm: the inverse of preprocess/model_format/octahedral.h.
#ifndef SPLICE_OCTAHEDRAL_GLSL
#define SPLICE_OCTAHEDRAL_GLSL

vec3 decode_octahedral(vec2 encoded) {
    vec3 n = vec3(encoded, 1 - abs(encoded.x) - abs(encoded.y));
    const float fold = max(-n.z, 0);
    n.x += n.x >= 0 ? -fold : fold;
    n.y += n.y >= 0 ? -fold : fold;
    return normalize(n);
}

#endif
