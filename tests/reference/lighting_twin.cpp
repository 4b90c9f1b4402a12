#include "tests/reference/lighting_twin.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace splice::reference {
namespace {

/// A light in the coordinates of the mesh's file.
struct PlacedLight {
    bool point;
    glm::dvec3 position;  // point lights
    glm::dvec3 to_light;  // directional lights, unit
    double range;
    glm::dvec3 colour;
};

PlacedLight place(const Light& light, const glm::dmat4& from_eye) {
    glm::dvec3 position = light.position, direction = light.direction;
    if (light.space == LightSpace::kCamera) {
        position = glm::dvec3(from_eye * glm::dvec4(position, 1));
        direction = glm::dmat3(from_eye) * direction;
    }
    return {light.kind == LightKind::kPoint, position, -glm::normalize(direction), light.range, light.colour};
}

}  // namespace

Shader lighting_twin(const Lighting& lighting, const IndexedMesh& mesh, const Camera& camera, bool two_sided) {
    const glm::dmat4 from_eye = glm::inverse(view_matrix(camera));
    std::vector<PlacedLight> lights;
    for (const Light& light : lighting.lights)
        lights.push_back(place(light, from_eye));
    const glm::dvec3 offset(mesh.source_offset.x(), mesh.source_offset.y(), mesh.source_offset.z());
    const double scale = mesh.source_scale;

    return [=, ambient = lighting.ambient, specular = lighting.specular, shininess = lighting.shininess,
            phong = lighting.highlight == HighlightModel::kPhong, rim = lighting.rim,
            rim_exponent = lighting.rim_exponent](const SurfacePoint& point) {
        const glm::dvec3 position = glm::dvec3(point.position) * scale + offset;
        const glm::dvec3 to_eye(point.to_eye);
        glm::dvec3 normal(point.normal);
        if (two_sided && glm::dot(normal, to_eye) < 0) normal = -normal;
        glm::dvec3 diffuse = ambient, highlight(0);
        for (const PlacedLight& light : lights) {
            const glm::dvec3 to_light = light.point ? glm::normalize(light.position - position) : light.to_light;
            const double cosine = glm::dot(normal, to_light);
            if (cosine <= 0) continue;
            const double distance = light.point ? glm::length(light.position - position) / light.range : 0;
            const glm::dvec3 strength = light.colour / (1 + distance * distance);
            diffuse += strength * cosine;
            const double lobe = phong ? glm::dot(2 * cosine * normal - to_light, to_eye)
                                      : glm::dot(normal, glm::normalize(to_light + to_eye));
            if (specular > 0) highlight += strength * std::pow(std::max(lobe, 0.0), shininess);
        }
        const double grazing = 1 - std::clamp(glm::dot(normal, to_eye), 0.0, 1.0);
        return glm::vec3(glm::dvec3(point.colour) * diffuse + specular * highlight +
                         rim * std::pow(grazing, rim_exponent));
    };
}

}  // namespace splice::reference
