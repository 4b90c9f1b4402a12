// What lies under the cursor: rays against the models in memory. No device, so it answers at once and the same
// anywhere.
#pragma once

#include "engine/scene/draw_list.h"
#include "engine/scene/scene.h"
#include "engine/scene/shown.h"
#include "engine/viewer/camera_controller.h"
#include "preprocess/model_format/model.h"

#include <cstdint>
#include <optional>
#include <span>

namespace splice {

struct PickableModel {
    const ModelView* model = nullptr;
    Transform transform;
};

struct PickOptions {
    Sides sides = Sides::kAsBaked;
    Shown shown = Shown::kHybrid;
};

struct Hit {
    std::size_t instance = 0;
    std::uint32_t patch = 0;
    format::Representation kind = format::Representation::kTriangles;
    std::uint64_t element = 0;  // the triangle (its first index / 3) or the surfel
    double distance = 0;        // world units along the ray
    glm::dvec3 point{0};        // world
    glm::dvec3 normal{0};       // world, unit; of the triangle's plane or the surfel's disk
};

/// The nearest triangle of a triangle patch, or disk of a surfel patch, that the ray meets. Surfaces seen from behind
/// count where they are drawn.
std::optional<Hit> pick(std::span<const PickableModel> models, const Ray& ray, const PickOptions& options = {});

}  // namespace splice
