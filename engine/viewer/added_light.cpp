#include "engine/viewer/added_light.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

namespace splice {

namespace {

// Over the viewer's other shoulder, from the sides, below, above, and from behind, where it draws outlines.
constexpr std::array<std::array<double, 3>, 7> kDirections{{{-0.8, -0.3, -0.6},
                                                            {1, 0, -0.2},
                                                            {-1, 0, -0.2},
                                                            {0, 1, -0.3},
                                                            {0, -1, -0.2},
                                                            {-0.9, -0.2, 0.4},
                                                            {0.9, -0.2, 0.4}}};
constexpr std::array kStrengths{0.5, 0.4, 0.3, 0.2, 0.1, 0.05};
constexpr int kNormals = 400;

// Evenly over the sphere, in the order of a spiral.
std::vector<glm::dvec3> normals() {
    std::vector<glm::dvec3> all;
    for (int i = 0; i < kNormals; ++i) {
        const double z = 1 - (2.0 * i + 1) / kNormals, radius = std::sqrt(1 - z * z);
        const double angle = 2 * std::numbers::pi * i / std::numbers::phi;
        all.emplace_back(radius * std::cos(angle), radius * std::sin(angle), z);
    }
    return all;
}

double strongest(const glm::dvec3& colour) {
    return std::max({colour.r, colour.g, colour.b});
}

// What a white surface of a normal shows of a light, camera space.
double shown(const Light& light, const glm::dmat3& to_camera, const glm::dvec3& target, const glm::dvec3& normal) {
    glm::dvec3 direction = light.kind == LightKind::kDirectional ? light.direction : target - light.position;
    if (light.space == LightSpace::kWorld) direction = to_camera * direction;
    const double length = glm::length(direction);
    return length > 0 ? strongest(light.colour) * std::max(0.0, -glm::dot(direction, normal) / length) : 0;
}

}  // namespace

Light added_light(const Lighting& lighting, const Camera& camera) {
    const glm::dmat3 to_camera(view_matrix(camera));
    const std::vector<glm::dvec3> all = normals();
    std::vector<double> before;
    for (const glm::dvec3& normal : all) {
        before.push_back(strongest(lighting.ambient));
        for (const Light& light : lighting.lights)
            before.back() += shown(light, to_camera, camera.target, normal);
    }
    const double most = std::max(1.0, *std::ranges::max_element(before));

    Light best;
    best.space = LightSpace::kCamera;
    best.colour = glm::dvec3(0);
    double best_gain = -1;
    for (const auto& [x, y, z] : kDirections) {
        Light light = best;
        light.direction = {x, y, z};
        for (const double strength : kStrengths) {
            light.colour = glm::dvec3(strength);
            double brightest = 0, gain = 0;
            for (std::size_t i = 0; i < all.size(); ++i) {
                const double more = shown(light, to_camera, camera.target, all[i]);
                brightest = std::max(brightest, before[i] + more);
                // Seen, and the more the darker it is.
                if (all[i].z > 0) gain += more * all[i].z / (0.1 + before[i]);
            }
            if (brightest > most) continue;
            if (gain > best_gain) {
                best_gain = gain;
                best = light;
            }
            break;
        }
    }
    return best;
}

}  // namespace splice
