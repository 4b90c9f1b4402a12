// A fragment of the attribute pass: how much its splat weighs there, and where on the disk that is. Whoever includes
// this declares the inputs. Needs frame.glsl, splat.glsl.
#ifndef SPLICE_ATTRIBUTE_FRAGMENT_GLSL
#define SPLICE_ATTRIBUTE_FRAGMENT_GLSL

struct AttributeFragment {
    bool reached;
    float weight;
    float depth;
    vec2 uv;  // radii, on the disk: beyond it nothing is extrapolated
};

AttributeFragment attribute_fragment(vec2 pixel, vec4 anchor_g, vec4 plane_map, vec4 conic_weight, float anchor_depth,
                                     vec3 rise_offset, vec3 skew, vec2 swell, vec4 clip) {
    AttributeFragment fragment;
    const SplatHit hit = cast_ray(pixel, anchor_g.xy, plane_map, anchor_g.zw, anchor_depth, rise_offset.yz, skew, swell,
                                  clip, rise_offset.x < 0);
    const vec2 d = pixel - anchor_g.xy;
    const vec3 conic = conic_weight.xyz;
    // x^T V^-1 x / 2. The affine ellipse holds the disk except where perspective bends it; there the disk itself takes
    // over, so that no pixel that the visibility pass wrote is left without a weight.
    float exponent = KERNEL_MOMENT * (conic.x * d.x * d.x + 2 * conic.y * d.x * d.y + conic.z * d.y * d.y);
    const bool in_footprint = exponent < KERNEL_SUPPORT2 && !hit.cut_off;
    fragment.reached = hit.on_disk || hit.beside_disk || in_footprint;
    exponent = min(min(exponent, hit.distance2), KERNEL_SUPPORT2);
    const float share = KERNEL == KERNEL_DISK ? exp(-exponent) : other_kernel(exponent);
    fragment.weight = conic_weight.w * (hit.beside_disk && !in_footprint ? BESIDE_WEIGHT : share);
    // Tested against the pushed-back depth of the visibility pass. Beyond the disk its plane may be anywhere; where the
    // footprint covers what the solid made visible, either depth will do.
    const float rise = abs(rise_offset.x);
    const float depth = hit.beside_disk && in_footprint ? min(hit.depth, hit.plane_depth) : hit.depth;
    fragment.depth = clamp(depth, anchor_depth - rise, anchor_depth + rise);
    const vec2 uv = in_footprint && !hit.on_disk ? hit.plane_uv : hit.uv;
    fragment.uv = uv * inversesqrt(max(dot(uv, uv), 1));
    return fragment;
}

#endif
