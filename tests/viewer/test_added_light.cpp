// Lights that are added: seen, different each time, and no surface becomes white by them that was not.
#include "engine/viewer/added_light.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>

using namespace splice;

namespace {

// Of a white surface in front of an observer of default_lighting's kind; all lights directional, in camera space.
double brightness(const Lighting& lighting, const glm::dvec3& normal) {
    double sum = lighting.ambient.r;
    for (const Light& light : lighting.lights)
        sum += light.colour.r * std::max(0.0, -glm::dot(glm::normalize(light.direction), normal));
    return sum;
}

double brightest(const Lighting& lighting) {
    double most = 0;
    for (int i = 0; i < 60; ++i)
        for (int j = 0; j < 60; ++j) {
            const double z = -1 + i / 29.5, angle = j * 0.10472, radius = std::sqrt(std::max(0.0, 1 - z * z));
            most = std::max(most, brightness(lighting, {radius * std::cos(angle), radius * std::sin(angle), z}));
        }
    return most;
}

}  // namespace

TEST_CASE("each added light is seen, comes from elsewhere, and saturates nothing") {
    Lighting lighting = default_lighting();
    for (int i = 0; i < 4; ++i) {
        const Light added = added_light(lighting, Camera{});
        CHECK(added.colour.r > 0);
        CHECK(added.space == LightSpace::kCamera);
        for (const Light& light : lighting.lights) {
            CAPTURE(i);
            CHECK(glm::dot(glm::normalize(light.direction), glm::normalize(added.direction)) < 0.95);
        }
        lighting.lights.push_back(added);
        CHECK(brightest(lighting) < 1.02);
    }
    // The first is strong enough to be seen: somewhere it adds a tenth.
    const Lighting before = default_lighting();
    Lighting after = before;
    after.lights.push_back(added_light(before, Camera{}));
    double gain = 0;
    for (const glm::dvec3 normal : {glm::dvec3(0, 0, 1), glm::dvec3(1, 0, 0), glm::dvec3(0, -1, 0)})
        gain = std::max(gain, brightness(after, normal) - brightness(before, normal));
    CHECK(gain > 0.1);
}

TEST_CASE("a light is found beside lights of the world, points, none, and far too many") {
    Lighting none;
    CHECK(added_light(none, Camera{}).colour.r > 0.3);
    Lighting world;
    Light sun;
    sun.space = LightSpace::kWorld;
    sun.direction = {0, 0, -1};
    sun.colour = glm::dvec3(0.88);
    world.lights.push_back(sun);
    Camera behind;
    behind.eye = {0, 0, -3};
    // Seen from behind, the sun lights nothing that is seen: the new light comes from where the viewer is.
    const Light added = added_light(world, behind);
    CHECK(added.colour.r > 0.2);
    Light lamp;
    lamp.kind = LightKind::kPoint;
    lamp.position = {0, 5, 0};
    world.lights = {lamp, lamp, lamp};
    CHECK(added_light(world, Camera{}).colour.r >= 0);
}
