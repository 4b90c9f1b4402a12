// Adds up everything that the pass reads, so that a wrong layout, a missing barrier or an overwritten image shows.
// INPUTS (0..3) input attachments and OUTPUTS (1..2) colour attachments are set on the compiler's command line.
#version 450

layout(constant_id = 0) const uint sampled_count = 0;

layout(set = 0, binding = 0) uniform sampler2D sampled[8];
#if INPUTS > 0
layout(set = 0, binding = 1, input_attachment_index = 0) uniform subpassInput input_0;
#endif
#if INPUTS > 1
layout(set = 0, binding = 2, input_attachment_index = 1) uniform subpassInput input_1;
#endif
#if INPUTS > 2
layout(set = 0, binding = 3, input_attachment_index = 2) uniform subpassInput input_2;
#endif

layout(push_constant) uniform Draw {
    vec4 tint;
    vec4 rectangle;
    float depth;
};

layout(location = 0) in vec2 place;
layout(location = 0) out vec4 colour;
#if OUTPUTS > 1
layout(location = 1) out vec4 second;
#endif

// Differs from read to read, so that swapped images show.
vec4 weighed(vec4 value, float weight) {
    return value * weight;
}

void main() {
    vec4 sum = tint;
    if (sampled_count > 0) sum += weighed(texture(sampled[0], place), 0.40);
    if (sampled_count > 1) sum += weighed(texture(sampled[1], place), 0.30);
    if (sampled_count > 2) sum += weighed(texture(sampled[2], place), 0.20);
    if (sampled_count > 3) sum += weighed(texture(sampled[3], place), 0.15);
    if (sampled_count > 4) sum += weighed(texture(sampled[4], place), 0.12);
    if (sampled_count > 5) sum += weighed(texture(sampled[5], place), 0.10);
    if (sampled_count > 6) sum += weighed(texture(sampled[6], place), 0.08);
    if (sampled_count > 7) sum += weighed(texture(sampled[7], place), 0.06);
#if INPUTS > 0
    sum += weighed(subpassLoad(input_0), 0.35);
#endif
#if INPUTS > 1
    sum += weighed(subpassLoad(input_1), 0.25);
#endif
#if INPUTS > 2
    sum += weighed(subpassLoad(input_2), 0.20);
#endif
    colour = fract(sum);
#if OUTPUTS > 1
    second = fract(sum.wzyx * 1.5);
#endif
}
