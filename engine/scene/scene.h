// What a frame shows: model instances, lights and the background. Plain data around models that live on a device.
#pragma once

#include "engine/scene/camera.h"

#include <memory>
#include <vector>

namespace splice {

class GpuModel;

/// world = rotation * (source * scale) + translation, source = coordinates of the model's file.
struct Transform {
    double scale = 1;             // uniform, > 0
    glm::dmat3 rotation{1.0};     // orthonormal
    glm::dvec3 translation{0.0};  // world units
};

struct Instance {
    std::shared_ptr<const GpuModel> model;
    Transform transform;
};

enum class LightKind { kDirectional, kPoint };
enum class LightSpace { kCamera, kWorld };

/// Colours are linear RGB. A directional light shines along `direction` with the same strength everywhere; a point
/// light at `position` fades as 1 / (1 + (distance / range)^2).
struct Light {
    LightKind kind = LightKind::kDirectional;
    LightSpace space = LightSpace::kWorld;  // camera: moves with the eye; x right, y up, z towards the viewer
    glm::dvec3 direction{0, 0, -1};         // directional: the way the light travels; need not be unit
    glm::dvec3 position{0.0};               // point
    double range = 1;                       // point: distance at half strength, world units
    glm::dvec3 colour{1.0};                 // linear, may exceed 1
    friend bool operator==(const Light&, const Light&) = default;
};

/// What a highlight measures: the angle between the normal and the half vector (Blinn 1977), or between the mirrored
/// light and the eye (Phong 1975).
enum class HighlightModel { kBlinnPhong, kPhong };

/// Ambient plus Lambert; highlights and the rim are off unless asked for.
struct Lighting {
    glm::dvec3 ambient{0.12};  // linear
    std::vector<Light> lights;
    double specular = 0;    // strength, 0 turns highlights off
    double shininess = 32;  // their exponent, >= 1
    HighlightModel highlight = HighlightModel::kBlinnPhong;
    double rim = 0;           // white added as rim (1 - n.v)^rim_exponent, whatever the lights; 0 turns it off
    double rim_exponent = 3;  // >= 1
    friend bool operator==(const Lighting&, const Lighting&) = default;
};

/// The lights that are used unless a scene names its own: one directional light over the viewer's left shoulder.
Lighting default_lighting();

struct Background {
    glm::dvec3 colour{1.0};    // sRGB-encoded, 0..1
    bool transparent = false;  // alpha is coverage; colour is ignored
};

/// Of an sRGB-encoded colour.
glm::dvec3 linear_light(const glm::dvec3& encoded);

struct Scene {
    std::vector<Instance> instances;
    Lighting lighting = default_lighting();
    Background background;
    Box bounds() const;        // of all instances' surfaces, world units: what a picture is framed by
    Box drawn_bounds() const;  // of their disks, too: what clip planes must hold
};

/// One model as it is, in the coordinates of its file, under the default lights.
Scene scene_of(std::shared_ptr<const GpuModel> model);

}  // namespace splice
