#version 450
layout(push_constant) uniform Constants { vec4 colour; float depth; };
layout(location = 0) out vec4 result;
void main() { result = colour; }
