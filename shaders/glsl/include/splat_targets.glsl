// What compute passes over splats read of the triangles, and write. Needs nothing.
#ifndef SPLICE_SPLAT_TARGETS_GLSL
#define SPLICE_SPLAT_TARGETS_GLSL

// Whether there are sums of normals and albedos, for the normalise pass to light, instead of colours.
layout(constant_id = 5) const bool DEFERRED = false;

layout(set = 3, binding = 0) uniform sampler2D scene_depth;
layout(set = 3, binding = 1, r32ui) uniform uimage2D splat_depth;  // bits of depth buffer values
layout(set = 3, binding = 2, rgba32f) uniform image2D accumulation;
layout(set = 3, binding = 3, rgba32f) uniform image2D normals;
layout(set = 3, binding = 4, rgba8) uniform writeonly image2D picture;
layout(set = 3, binding = 5, std430) buffer PointSums {
    uint point_sums[];  // [y][x][channel]: 64 bits, the lower half first; in units of 2^-32
};

// Channels of points: accumulation, normals.
const uint CHANNELS = DEFERRED ? 8 : 4;
// Added to what may be negative, times the weight.
const float CHANNEL_BIAS = 4;

#endif
