#version 450
// One triangle that covers the target, at the depth given.
layout(push_constant) uniform Constants { vec4 colour; float depth; };
void main() {
    vec2 corner = vec2((gl_VertexIndex << 1) & 2, gl_VertexIndex & 2);
    gl_Position = vec4(corner * 2.0 - 1.0, depth, 1.0);
}
