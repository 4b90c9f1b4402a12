// The records of a model file's surfels and what they say: the one place where shaders read them. Needs frame.glsl,
// octahedral.glsl.
#ifndef SPLICE_SURFEL_RECORD_GLSL
#define SPLICE_SURFEL_RECORD_GLSL

// format::Surfel or format::PackedSurfel, decoded.
struct SurfelRecord {
    vec3 position;
    float radius;  // below 0: an ellipse, engine/scene/ellipse_record.h
    vec2 normal;  // octahedral
    vec3 colour;  // sRGB-encoded
    float bend_0;  // format::Surfel::shading_bend, 1 for the largest
    vec4 bend_1_4;
    uint patch_number;
    uint extent;    // preprocess/model_format/surfel_extent.h; of a packed surfel, without epsilon
    float epsilon;  // radii
    uint clip;      // preprocess/model_format/surfel_clip.h; of an ellipse, its axes
};

bool is_packed() { return (instance.flags & INSTANCE_PACKED) != 0; }

// Records are read as whole texels or attributes of 16 bytes: a packed one is `first`, another both.

// kPlaceSteps
const float PLACE_STEPS = 1048576;

vec3 position_of(uvec4 first) {
    if (!is_packed()) return uintBitsToFloat(first.xyz);
    const uvec3 steps = uvec3(first.x, first.x >> 20 | first.y << 12, first.y >> 8) & 0xfffff;
    return vec3(steps) / PLACE_STEPS - 0.5;
}

float radius_of(uvec4 first) {
    return unpackHalf2x16(is_packed() ? first.z >> 28 | (first.w >> 20 & 0x3ff) << 4 : first.w).x;
}

vec2 normal_of(uvec4 first, uvec4 second) {
    if (!is_packed()) return unpackSnorm2x16(second.x);
    const int bits = int(first.w);
    return max(vec2(bitfieldExtract(bits, 0, 10), bitfieldExtract(bits, 10, 10)) / 511.0, vec2(-1));
}

// kSwellStep, kSwellStep, kEpsilonStep; kSwellOne, kSwellOne, kEpsilonOne
const vec3 EXTENT_POWERS = vec3(0.4, 0.4, 0.25);
const vec3 EXTENT_ONES = vec3(31, 31, 24);

const uint EXTENT_SWELL = 0x3ff;  // bits of above and below

// Above, below, epsilon, in radii.
vec3 decode_extent(uint bits) {
    const uvec3 steps = uvec3(bits & 31, bits >> 5 & 31, bits >> 10);
    return mix(exp2(EXTENT_POWERS * (vec3(steps) - EXTENT_ONES)), vec3(0), equal(steps, uvec3(0)));
}

// kPackedEpsilon, kPackedBlock
const float PACKED_EPSILON = 1.5;
const uint PACKED_BLOCK = 1024;

// `index`: of the surfel, in its model.
SurfelRecord decode_surfel(uvec4 first, uvec4 second, uint index) {
    SurfelRecord record;
    record.position = position_of(first);
    record.radius = radius_of(first);
    record.normal = normal_of(first, second);
    if (is_packed()) {
        record.extent = first.y >> 28 | (first.w >> 30 & 1) << 4 | (first.z >> 24 & 15 | first.w >> 31 << 4) << 5;
        const vec2 swell = decode_extent(record.extent).xy;
        const float steps = log2(PACKED_EPSILON + swell.x + swell.y) / EXTENT_POWERS.z;
        record.epsilon = exp2(EXTENT_POWERS.z * ceil(steps));  // as all surfels have it
        record.colour = unpackUnorm4x8(first.z).rgb;
        record.bend_0 = 0;
        record.bend_1_4 = vec4(0);
        record.patch_number = index / PACKED_BLOCK & 0xffff;
        record.clip = 0;
    } else {
        record.extent = first.w >> 16;
        record.epsilon = decode_extent(record.extent).z;
        record.colour = unpackUnorm4x8(second.y).rgb;
        record.bend_0 = unpackSnorm4x8(second.y).w;
        record.bend_1_4 = unpackSnorm4x8(second.z);
        record.patch_number = second.w & 0xffff;
        record.clip = second.w >> 16;
    }
    return record;
}

#endif
