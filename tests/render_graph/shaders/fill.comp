#version 450
layout(local_size_x = 64) in;
layout(set = 0, binding = 0) buffer Values { uint values[]; };
layout(push_constant) uniform Constants { uint factor; uint count; };
void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i < count) values[i] = values[i] * factor + i;
}
