#include "engine/scene/scene.h"

#include "engine/scene/gpu_model.h"

#include <cmath>

namespace splice {

glm::dvec3 linear_light(const glm::dvec3& encoded) {
    const auto decode = [](double c) { return c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4); };
    return {decode(encoded.r), decode(encoded.g), decode(encoded.b)};
}

Lighting default_lighting() {
    Lighting lighting;
    Light key;
    key.space = LightSpace::kCamera;
    key.direction = {0.5, -0.6, -1};
    key.colour = glm::dvec3(0.7);
    lighting.lights.push_back(key);
    return lighting;
}

namespace {

Box bounds_of(const std::vector<Instance>& instances, const Box& (GpuModel::*which)() const) {
    Box all;
    for (const Instance& instance : instances) {
        const Box& box = ((*instance.model).*which)();
        if (box.empty()) continue;
        const Transform& transform = instance.transform;
        for (int corner = 0; corner < 8; ++corner) {
            const glm::dvec3 p((corner & 1) ? box.maximum.x : box.minimum.x,
                               (corner & 2) ? box.maximum.y : box.minimum.y,
                               (corner & 4) ? box.maximum.z : box.minimum.z);
            all.extend(transform.rotation * (p * transform.scale) + transform.translation);
        }
    }
    return all;
}

}  // namespace

Box Scene::bounds() const {
    return bounds_of(instances, &GpuModel::bounds);
}

Box Scene::drawn_bounds() const {
    return bounds_of(instances, &GpuModel::drawn_bounds);
}

Scene scene_of(std::shared_ptr<const GpuModel> model) {
    Scene scene;
    scene.instances.push_back({std::move(model), {}});
    return scene;
}

}  // namespace splice
