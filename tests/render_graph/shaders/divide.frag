#version 450
// Weighted colours become colours, over what is behind; depth is shown in alpha.
layout(input_attachment_index = 0, set = 0, binding = 0) uniform subpassInput behind;
layout(input_attachment_index = 1, set = 0, binding = 1) uniform subpassInput accumulation;
layout(input_attachment_index = 2, set = 0, binding = 2) uniform subpassInput depth;
layout(location = 0) out vec4 result;
void main() {
    vec4 sum = subpassLoad(accumulation);
    vec3 colour = sum.a > 0.0 ? sum.rgb / sum.a : subpassLoad(behind).rgb;
    result = vec4(colour, subpassLoad(depth).r);
}
