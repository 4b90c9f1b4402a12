// A triangle that covers the screen.
#version 460

void main() {
    gl_Position = vec4(float((gl_VertexIndex & 1) << 2) - 1, float((gl_VertexIndex & 2) << 1) - 1, 0.5, 1);
}
