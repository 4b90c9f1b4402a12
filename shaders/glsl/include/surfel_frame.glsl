// From a surfel of the model file to its splat on screen and its lit colour: shared by every backend. Needs frame.glsl,
// octahedral.glsl, colour.glsl, lighting.glsl, splat.glsl, surfel_record.glsl.
#ifndef SPLICE_SURFEL_FRAME_GLSL
#define SPLICE_SURFEL_FRAME_GLSL

bool is_ellipse(SurfelRecord record) { return record.radius < 0; }

// The same surfels whatever else is drawn with them.
bool in_sample(vec3 position) {
    uint h = floatBitsToUint(position.x) * 0x9e3779b9u;
    h = (h ^ floatBitsToUint(position.y) ^ (h >> 15)) * 0x9e3779b9u;
    h = (h ^ floatBitsToUint(position.z) ^ (h >> 15)) * 0x9e3779b9u;
    h ^= h >> 16;
    h *= 0x85ebca6bu;
    h ^= h >> 13;
    return float(h >> 8) < frame.sample_share * 16777216.0;
}

struct SurfelFrame {
    vec3 centre, normal, s, t;  // view space; s and t as format::Surfel::shading_bend means them, or an ellipse's axes
    float radius;               // along s, world units
    float ratio;                // of the half axis along t to it; 1 for a disk
};

// kClipDirections, kClipSteps
const float CLIP_DIRECTIONS = 64;
const float CLIP_STEPS = 1023;

vec3 decode_clip(uint bits) {
    const uint cut = bits >> 6;
    const float turn = 6.283185307 / CLIP_DIRECTIONS * float(bits & 63);
    return cut == 0 ? NO_CLIP : vec3(cos(turn), sin(turn), 1 - float(cut) / CLIP_STEPS);
}

// kAxisDirections, kAxisSteps of engine/scene/ellipse_record.h
const float AXIS_DIRECTIONS = 256;
const float AXIS_STEPS = 255;

// Of an ellipse, to its axes.
void turn_to_axes(SurfelRecord record, inout SurfelFrame surfel) {
    const bool turns = is_ellipse(record);
    const float turn = 3.141592654 / AXIS_DIRECTIONS * float(record.clip & 0xff);
    const vec3 s = surfel.s, t = surfel.t;
    surfel.s = turns ? cos(turn) * s + sin(turn) * t : s;
    surfel.t = turns ? cos(turn) * t - sin(turn) * s : t;
    surfel.ratio = turns ? float(record.clip >> 8) / AXIS_STEPS : 1;
}

// The splat of a surfel; false if it is not to be drawn.
bool surfel_splat(SurfelRecord record, out Splat splat, out SurfelFrame surfel) {
    const vec3 centre = surfel.centre = to_view_space(record.position);
    const vec3 model_normal = decode_octahedral(record.normal);
    const vec3 normal = surfel.normal = normal_to_view_space(model_normal);
    tangents_of(model_normal, surfel.s, surfel.t);
    surfel.s = normal_to_view_space(surfel.s);
    surfel.t = normal_to_view_space(surfel.t);
    turn_to_axes(record, surfel);
    const bool away = (instance.flags & INSTANCE_TWO_SIDED) == 0 && beyond_horizon(normal, centre);
    const float baked_radius = abs(record.radius) * instance.scale;
    float radius = baked_radius;
    bool drawn = !away;
    if (VIEW == VIEW_SAMPLES) {
        drawn = drawn && in_sample(record.position);
        radius *= frame.sample_radius;
    }
    surfel.radius = radius;
    const vec2 swell = decode_extent(record.extent).xy;
    const vec3 clip = decode_clip(record.clip);
    const bool made = make_splat(centre, normal, surfel.s, surfel.t, radius, surfel.ratio,
                                 VIEW == VIEW_SAMPLES ? vec2(0) : swell,
                                 VIEW == VIEW_SAMPLES || is_ellipse(record) ? NO_CLIP : clip,
                                 record.epsilon * baked_radius * instance.epsilon_scale, splat);
    return drawn && made;
}

// format::kLargestBend
const vec2 LARGEST_LEAN = vec2(1);
const vec3 LARGEST_TURN = vec3(0.5);

// Lit once a surfel, to first order: the colour at the centre and how it changes along both tangents, a radius, as the
// shading normal turns.
struct SurfelColour {
    vec3 centre, along_u, along_v;
};

// The centre, and both ends of both diameters.
const int LIT_POINTS = 5;
const vec2 LIT_AT[LIT_POINTS] = vec2[](vec2(0), vec2(1, 0), vec2(-1, 0), vec2(0, 1), vec2(0, -1));

vec3 surfel_albedo(SurfelRecord record) {
    const bool finest = VIEW == VIEW_LEVELS && !is_ellipse(record);
    return view_albedo(decode_srgb(record.colour), finest ? 0 : record.patch_number, true);
}

// The shading normal, to first order: at the centre, where it is unit, and how it changes along both tangents, a
// radius.
struct SurfelNormals {
    vec3 centre, along_u, along_v;
};

// The shading normal of the disk's side that its plane's normal is on, not unit. `uv`: on the disk, in radii.
vec3 leaning_normal(SurfelRecord record, SurfelFrame surfel, vec2 uv) {
    const vec2 lean = LARGEST_LEAN * vec2(record.bend_0, record.bend_1_4.x);
    const vec3 turn = LARGEST_TURN * record.bend_1_4.yzw;
    const vec2 tilt = lean + vec2(dot(turn.xy, uv), dot(turn.yz, uv));
    return surfel.normal + tilt.x * surfel.s + tilt.y * surfel.t;
}

// 1, or -1 where a two-sided surface is seen from behind. Its end nearest the eye decides: of a disk right behind a
// silhouette that is what shows, and it belongs to the surface before the silhouette if that bends so.
float side_of(SurfelRecord record, SurfelFrame surfel) {
    const vec3 to_eye = normalize(towards_eye(surfel.centre));
    const vec3 normal = normalize(leaning_normal(record, surfel, vec2(dot(surfel.s, to_eye), dot(surfel.t, to_eye))));
    return dot(face_the_eye(normal, surfel.centre), normal) < 0 ? -1 : 1;
}

SurfelNormals surfel_normals(SurfelRecord record, SurfelFrame surfel) {
    const vec2 lean = LARGEST_LEAN * vec2(record.bend_0, record.bend_1_4.x);
    const vec3 turn = LARGEST_TURN * record.bend_1_4.yzw;
    const vec3 centre = surfel.normal + lean.x * surfel.s + lean.y * surfel.t;
    const float scale = side_of(record, surfel) * inversesqrt(dot(centre, centre));
    return SurfelNormals(scale * centre, scale * (turn.x * surfel.s + turn.y * surfel.t),
                         scale * (turn.y * surfel.s + turn.z * surfel.t));
}

// `side`: side_of. `uv`: on the disk, in radii.
vec3 shading_normal(SurfelRecord record, SurfelFrame surfel, float side, vec2 uv) {
    return side * normalize(leaning_normal(record, surfel, uv));
}

// All points under one light before the next light: reading a light costs more than using it.
SurfelColour surfel_colour(SurfelRecord record, SurfelFrame surfel) {
    const float side = side_of(record, surfel);
    vec3 normals[LIT_POINTS], positions[LIT_POINTS], diffuse[LIT_POINTS], highlights[LIT_POINTS], lit[LIT_POINTS];
    [[unroll]] for (int p = 0; p < LIT_POINTS; ++p) {
        normals[p] = shading_normal(record, surfel, side, LIT_AT[p]);
        positions[p] =
            surfel.centre + surfel.radius * (LIT_AT[p].x * surfel.s + LIT_AT[p].y * (surfel.ratio * surfel.t));
        diffuse[p] = frame.ambient;
        highlights[p] = vec3(0);
    }
    if (VIEW != VIEW_NORMALS) {
        for (uint i = 0; i < frame.light_count; ++i) {
            const LightRecord record_of_light = light_record(i);
            [[unroll]] for (int p = 0; p < LIT_POINTS; ++p) {
                const Light light = light_at(record_of_light, normals[p], positions[p]);
                diffuse[p] += light.diffuse;
                highlights[p] += light.highlight;
            }
        }
    }
    const vec3 albedo = surfel_albedo(record);
    [[unroll]] for (int p = 0; p < LIT_POINTS; ++p) {
        lit[p] = VIEW == VIEW_NORMALS ? normal_colour(normals[p])
                                      : albedo * diffuse[p] + frame.specular * highlights[p] +
                                            rim_light(normals[p], positions[p]);
    }
    SurfelColour colour;
    colour.centre = lit[0];
    colour.along_u = 0.5 * (lit[1] - lit[2]);
    colour.along_v = 0.5 * (lit[3] - lit[4]);
    return colour;
}

#endif
