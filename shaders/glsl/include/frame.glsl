// What every pass knows about the frame and the instance being drawn. The C++ mirror is engine/passes/shader_types.h;
// tests/engine/test_shader_layouts.cpp compares the two by reflection.
#ifndef SPLICE_FRAME_GLSL
#define SPLICE_FRAME_GLSL

// What never changes within a frame and is worth a pipeline of its own: no fragment branches on it.
layout(constant_id = 1) const uint VIEW = 0;  // VIEW_*
layout(constant_id = 2) const bool ORTHOGRAPHIC = false;
// What the scene's lights need; a software device would compute what they do not, and mask it.
layout(constant_id = 6) const uint LIGHTING = 0;  // LIGHTING_*
const uint LIGHTING_HIGHLIGHTS = 1;
const uint LIGHTING_PHONG = 2;  // highlights by Phong's mirrored light, not Blinn's half vector
const uint LIGHTING_RIM = 4;
const uint LIGHTING_LAMPS = 8;  // point lights

// engine/scene/view.h
const uint VIEW_SHADED = 0;
const uint VIEW_DEPTH = 1;
const uint VIEW_VISIBILITY = 2;
const uint VIEW_ACCUMULATION = 3;
const uint VIEW_NORMALS = 4;
const uint VIEW_PATCHES = 5;
const uint VIEW_REPRESENTATION = 6;
const uint VIEW_WIREFRAME = 7;
const uint VIEW_OVERLAP = 8;
const uint VIEW_SAMPLES = 9;
const uint VIEW_LEVELS = 12;
const uint VIEW_BOXES = 13;

layout(set = 0, binding = 0, std140) uniform FrameUniforms {
    mat4 projection;       // view space to clip space, y down, reversed depth
    vec2 viewport;         // pixels
    float pixel_scale;     // window pixels per unit at depth 1 (perspective) or anywhere (orthographic)
    float near_plane;      // depth, world units
    float far_plane;       // orthographic only
    uint prefilter;        // 0 or 1
    float sample_share;    // VIEW_SAMPLES: share of the surfels that is drawn
    float sample_radius;   // VIEW_SAMPLES: factor on their radii
    vec3 ambient;          // linear
    uint light_count;
    float specular;
    float shininess;
    float rim;
    float rim_exponent;
    vec4 background;       // linear; alpha 0: transparent
    uint samples_per_side; // of a pixel of the picture; all else counts samples as pixels
} frame;

struct LightRecord {
    vec4 vector;    // directional: xyz towards the light, view space, unit, w = 0; point: xyz its position, w = 1
    vec4 colour;    // rgb linear; a = 1 / range^2 of a point light
};
// Texels, two a light, not a storage buffer: software devices read those lane by lane.
layout(set = 0, binding = 1) uniform samplerBuffer light_texels;

LightRecord light_record(uint number) {
    return LightRecord(texelFetch(light_texels, int(2 * number)), texelFetch(light_texels, int(2 * number + 1)));
}

const uint INSTANCE_TWO_SIDED = 1;
const uint INSTANCE_FIRST_SEGMENT = 2;  // compute: nothing was gathered yet
const uint INSTANCE_LAST_SEGMENT = 4;
const uint INSTANCE_TILED = 8;    // setup: splats go to the tiles that they touch
const uint INSTANCE_LISTED = 16;  // setup: and to the list of those that are rasterised
const uint INSTANCE_PACKED = 32;  // surfels are format::PackedSurfel

layout(push_constant, std430) uniform InstanceConstants {
    vec4 model_to_view[3];  // rows of the affine map from unit-box to view space: uniform scale, rotation, translation
    float scale;            // world units per unit-box unit
    float epsilon_scale;    // the user's
    uint flags;             // INSTANCE_*
    uint first_patch;       // added to patch numbers, so that instances get different colours
    uint first_surfel;      // of the bound surfels
    uint surfel_count;      // of passes over what setup made of them: how many groups
    uint first_group;       // compute: number of the first of their groups
    uint first_word;        // gathering: where in the cells' masks a segment begins
    uint first_source;      // setup: of its groups
} instance;

#ifdef COPY_UNIFORMS
// A software device may read uniforms invocation by invocation wherever some of them may rest: shaders that use many in
// loops read them once, at the start of main().
struct FrameCopy {
    vec2 viewport;
    float pixel_scale, near_plane, far_plane;
    uint prefilter;
    float sample_share, sample_radius;
    vec3 ambient;
    uint light_count;
    float specular, shininess, rim, rim_exponent;
} frame_copy;
struct InstanceCopy {
    vec4 model_to_view[3];
    float scale, epsilon_scale;
    uint flags, first_patch, surfel_count, first_group, first_source;
} instance_copy;

void copy_uniforms() {
    frame_copy = FrameCopy(frame.viewport, frame.pixel_scale, frame.near_plane, frame.far_plane, frame.prefilter,
                           frame.sample_share, frame.sample_radius, frame.ambient, frame.light_count, frame.specular,
                           frame.shininess, frame.rim, frame.rim_exponent);
    instance_copy = InstanceCopy(instance.model_to_view, instance.scale, instance.epsilon_scale, instance.flags,
                                 instance.first_patch, instance.surfel_count,
                                 instance.first_group, instance.first_source);
}
#define frame frame_copy
#define instance instance_copy
#endif

vec3 to_view_space(vec3 position) {
    const vec4 p = vec4(position, 1);
    return vec3(dot(instance.model_to_view[0], p), dot(instance.model_to_view[1], p),
                dot(instance.model_to_view[2], p));
}

vec3 normal_to_view_space(vec3 normal) {
    return normalize(vec3(dot(instance.model_to_view[0].xyz, normal), dot(instance.model_to_view[1].xyz, normal),
                          dot(instance.model_to_view[2].xyz, normal)));
}

// The point of view space that shows at a window position.
vec3 from_window(vec2 window, float depth) {
    const vec2 q = (window - frame.viewport * 0.5) / frame.pixel_scale * (ORTHOGRAPHIC ? 1 : depth);
    return vec3(q.x, -q.y, -depth);
}

// From a point of view space towards the eye, not normalised.
vec3 towards_eye(vec3 position) { return ORTHOGRAPHIC ? vec3(0, 0, 1) : -position; }

// Surfels are disks, and their normals are interpolated: a little beyond the horizon, by this cosine, a disk that is
// seen from behind still belongs to the rim of a surface that is seen from the front. engine/scene/draw_list.cpp culls
// patches with the same number.
const float HORIZON = -0.25;

bool beyond_horizon(vec3 normal, vec3 position) {
    return dot(normal, normalize(towards_eye(position))) < HORIZON;
}

// Depth buffer value of a depth (distance along the view axis); nearer is greater.
float encode_depth(float depth) {
    return ORTHOGRAPHIC ? (frame.far_plane - depth) / (frame.far_plane - frame.near_plane)
                                   : frame.near_plane / depth;
}

float decode_depth(float value) {
    return ORTHOGRAPHIC ? frame.far_plane - value * (frame.far_plane - frame.near_plane)
                                   : frame.near_plane / value;
}

#endif
