// One light model for triangles (per pixel) and surfels (per surfel): ambient, Lambert; highlights and a rim where
// asked for. Needs frame.glsl.
#ifndef SPLICE_LIGHTING_GLSL
#define SPLICE_LIGHTING_GLSL

// What one light adds to a point; `normal` is unit and already on the side to be lit.
struct Light {
    vec3 diffuse, highlight;
};

Light light_at(LightRecord light, vec3 normal, vec3 position) {
    vec3 to_light = light.vector.xyz, strength = light.colour.rgb;
    if ((LIGHTING & LIGHTING_LAMPS) != 0) {
        const vec3 offset = light.vector.xyz - position * light.vector.w;
        to_light = normalize(offset);
        strength /= 1 + light.colour.a * dot(offset, offset);
    }
    const float cosine = dot(normal, to_light);
    // Choices, not branches: see make_splat.
    const bool unlit = cosine <= 0;
    vec3 highlight = vec3(0);
    if ((LIGHTING & LIGHTING_HIGHLIGHTS) != 0) {
        const vec3 to_eye = normalize(towards_eye(position));
        const float lobe = (LIGHTING & LIGHTING_PHONG) != 0 ? dot(reflect(-to_light, normal), to_eye)
                                            : dot(normal, normalize(to_light + to_eye));
        highlight = unlit ? vec3(0) : strength * pow(max(lobe, 0), frame.shininess);
    }
    return Light(unlit ? vec3(0) : strength * cosine, highlight);
}

// What a surface seen at a grazing angle adds, whatever the lights.
float rim_light(vec3 normal, vec3 position) {
    if ((LIGHTING & LIGHTING_RIM) == 0) return 0;
    const float facing = clamp(dot(normal, normalize(towards_eye(position))), 0, 1);
    return frame.rim * pow(1 - facing, frame.rim_exponent);
}

// Linear colours, view space.
vec3 shade(vec3 albedo, vec3 normal, vec3 position) {
    vec3 diffuse = frame.ambient;
    vec3 highlight = vec3(0);
    for (uint i = 0; i < frame.light_count; ++i) {
        const Light light = light_at(light_record(i), normal, position);
        diffuse += light.diffuse;
        highlight += light.highlight;
    }
    return albedo * diffuse + frame.specular * highlight + rim_light(normal, position);
}

// Two-sided surfaces show the side that is looked at. What is seen from behind before the horizon is lit as what it
// borders on; turned to the eye, it would be a speck on the silhouette.
vec3 face_the_eye(vec3 normal, vec3 position) {
    const bool turned = (instance.flags & INSTANCE_TWO_SIDED) != 0 && beyond_horizon(normal, position);
    return turned ? -normal : normal;
}

// What the views light instead of `albedo`; `patch_number` and `is_surfel` say where the point belongs.
vec3 view_albedo(vec3 albedo, uint patch_number, bool is_surfel) {
    switch (VIEW) {
        case VIEW_PATCHES: return label_colour(patch_number + instance.first_patch);
        case VIEW_REPRESENTATION: return is_surfel ? vec3(0.85, 0.32, 0.06) : vec3(0.10, 0.30, 0.75);
        case VIEW_SAMPLES: return vec3(0.85, 0.32, 0.06);
        case VIEW_LEVELS: return is_surfel ? level_colour(patch_number) : triangle_level_colour(patch_number);
        case VIEW_WIREFRAME: return is_surfel ? vec3(0.75, 0.60, 0.45) : vec3(0.85);
        case VIEW_BOXES: return vec3(0.6);
        default: return albedo;
    }
}

vec3 normal_colour(vec3 normal) { return normal * 0.5 + 0.5; }

vec3 view_colour(vec3 albedo, vec3 normal, vec3 position, uint patch_number, bool is_surfel) {
    if (VIEW == VIEW_NORMALS) return normal_colour(normal);
    return shade(view_albedo(albedo, patch_number, is_surfel), normal, position);
}

#endif
