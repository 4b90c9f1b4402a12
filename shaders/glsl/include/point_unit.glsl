// Needs frame.glsl, splat_record.glsl.
#ifndef SPLICE_POINT_UNIT_GLSL
#define SPLICE_POINT_UNIT_GLSL

// What sums of depths are counted in, so that fixed point suits models of any size.
float point_depth_unit() { return ORTHOGRAPHIC ? depth_range() : frame.near_plane; }

#endif
