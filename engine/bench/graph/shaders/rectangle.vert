// A rectangle of the target, in one triangle strip without vertex buffers.
#version 450

layout(push_constant) uniform Draw {
    vec4 tint;
    vec4 rectangle;  // left, top, right, bottom; 0..1 of the target
    float depth;
};

layout(location = 0) out vec2 place;  // 0..1 of the target

void main() {
    place = vec2((gl_VertexIndex & 1) == 0 ? rectangle.x : rectangle.z,
                 (gl_VertexIndex & 2) == 0 ? rectangle.y : rectangle.w);
    gl_Position = vec4(place * 2 - 1, depth, 1);
}
