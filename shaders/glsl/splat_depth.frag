// What compute passes found visible becomes the frame's depth and, by the stencil value, the surfels' own.
#version 460

layout(set = 1, binding = 0) uniform usampler2D splat_depth;  // bits of depth buffer values

void main() { gl_FragDepth = uintBitsToFloat(texelFetch(splat_depth, ivec2(gl_FragCoord.xy), 0).r); }
