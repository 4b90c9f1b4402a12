// Bounds of consecutive surfels against what setup would find of each: nothing that it keeps may be culled, and what is
// certain it must keep.
#include "engine/scene/splat_reach.h"
#include "engine/scene/surfel_bounds.h"
#include "preprocess/model_format/half.h"
#include "preprocess/model_format/octahedral.h"

#include <catch2/catch.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

using namespace splice;

namespace {

constexpr std::uint32_t kWidth = 320, kHeight = 200;

format::Surfel surfel_at(const glm::vec3& position, const glm::vec3& normal, float radius) {
    format::Surfel surfel{};
    for (int axis = 0; axis < 3; ++axis)
        surfel.position[axis] = position[axis];
    surfel.normal = encode_octahedral(normal.x, normal.y, normal.z);
    surfel.radius = half_at_least(radius);
    return surfel;
}

struct Eye {
    Camera camera;
    glm::dmat4 model_to_view{1};
    double scale = 1;
    bool two_sided = false;
};

SurfelSight sight_from(const Eye& eye) {
    return {eye.camera, kWidth, kHeight, eye.model_to_view, eye.scale, eye.two_sided};
}

std::vector<SurfelBounds> bounds_of(const std::vector<format::Surfel>& surfels) {
    Model model;
    model.surfels = surfels;
    return bound_surfels(view_of(model), {});
}

// may_show of splat_setup.comp, in single precision as there.
bool may_show(const format::Surfel& surfel, const Eye& eye) {
    const glm::mat4 to_view(eye.model_to_view);
    const glm::vec3 centre(to_view * glm::vec4(surfel.position[0], surfel.position[1], surfel.position[2], 1));
    const float depth = -centre.z, scale = static_cast<float>(eye.scale);
    const float reach = std::sqrt(2.0f) * std::abs(float_from_half(surfel.radius)) * std::abs(scale);
    const auto pixels = static_cast<float>(pixel_scale(eye.camera, kHeight));
    const glm::vec2 half = (0.5f * glm::vec2(kWidth, kHeight) + static_cast<float>(kSetupReach)) / pixels;
    const glm::vec2 across = glm::abs(glm::vec2(centre));
    const glm::vec2 outside =
        eye.camera.orthographic ? across - half : (across - half * depth) / glm::sqrt(1.0f + half * half);
    if (std::max(outside.x, outside.y) > reach || depth + reach < static_cast<float>(eye.camera.near_plane))
        return false;
    if (eye.two_sided) return true;
    const auto n = decode_octahedral(surfel.normal);
    const glm::vec3 normal = glm::normalize(glm::mat3(to_view) * glm::vec3(n[0], n[1], n[2]));
    const glm::vec3 to_eye = eye.camera.orthographic ? glm::vec3(0, 0, 1) : glm::normalize(-centre);
    return glm::dot(normal, to_eye) >= static_cast<float>(kHorizon);
}

struct Tally {
    int none = 0, all = 0;                // what bounds tell
    int really_none = 0, really_all = 0;  // what is
};

void compare(const std::vector<format::Surfel>& surfels, const Eye& eye, Tally& tally) {
    const std::vector<SurfelBounds> bounds = bounds_of(surfels);
    const SurfelSight sight = sight_from(eye);
    for (std::size_t run = 0; run < bounds.size(); ++run) {
        const auto first = surfels.begin() + static_cast<std::ptrdiff_t>(run * kBoundedSurfels);
        const auto end = std::min(first + kBoundedSurfels, surfels.end());
        const auto shown = std::count_if(first, end, [&](const format::Surfel& one) { return may_show(one, eye); });
        const bool none = shown == 0, all = shown == end - first;
        const Sight seen = sight.of(bounds[run]);
        if (seen == Sight::kNone) REQUIRE(none);
        if (seen == Sight::kAll) REQUIRE(all);
        tally.none += seen == Sight::kNone ? 1 : 0;
        tally.all += seen == Sight::kAll ? 1 : 0;
        tally.really_none += none ? 1 : 0;
        tally.really_all += all ? 1 : 0;
    }
}

class Random {
  public:
    explicit Random(unsigned seed) : engine_(seed) {}
    double within(double low, double high) { return std::uniform_real_distribution<double>(low, high)(engine_); }
    bool chance(double share) { return within(0, 1) < share; }
    glm::dvec3 direction() {
        std::normal_distribution<double> normal;
        glm::dvec3 v(0);
        while (glm::length(v) < 1e-3)
            v = {normal(engine_), normal(engine_), normal(engine_)};
        return glm::normalize(v);
    }

  private:
    std::mt19937 engine_;
};

// Runs of surfels about a place, their normals about a direction; how far about, from not at all to anywhere.
std::vector<format::Surfel> cloud(Random& random) {
    std::vector<format::Surfel> surfels;
    const int runs = 8;
    for (int run = 0; run < runs; ++run) {
        const glm::dvec3 place = 0.5 * random.direction() * random.within(0, 1), facing = random.direction();
        const double spread = random.chance(0.2) ? 0 : std::pow(10, random.within(-4, 0.7));
        const double size = random.chance(0.2) ? 0 : std::pow(10, random.within(-4, -0.5));
        const double radius = random.chance(0.1) ? 0 : std::pow(10, random.within(-5, -0.5));
        const std::uint32_t count = run == runs - 1 ? 1 + random.chance(0.5) * 30u : kBoundedSurfels;
        for (std::uint32_t i = 0; i < count; ++i)
            surfels.push_back(surfel_at(glm::vec3(place + size * random.within(0, 1) * random.direction()),
                                        glm::vec3(facing + spread * random.within(0, 1) * random.direction()),
                                        static_cast<float>(radius * random.within(0.1, 1))));
    }
    return surfels;
}

Eye eye_anywhere(Random& random) {
    Eye eye;
    eye.camera.orthographic = random.chance(0.3);
    eye.camera.orthographic_height = std::pow(10, random.within(-1, 0.5));
    eye.camera.fov_y_degrees = random.within(5, 150);
    eye.camera.near_plane = std::pow(10, random.within(-3, 0));
    eye.two_sided = random.chance(0.15);
    eye.scale = std::pow(10, random.within(-3, 3)) * (random.chance(0.3) ? -1 : 1);
    const double size = std::abs(eye.scale);
    eye.camera.near_plane *= size;
    eye.camera.orthographic_height *= size;
    const glm::dvec3 offset = size * glm::dvec3(random.within(-2, 2), random.within(-1.5, 1.5), random.within(-4, 0.7));
    const glm::dmat4 turn = glm::rotate(glm::dmat4(1), random.within(0, 6.3), random.direction());
    eye.model_to_view = glm::translate(glm::dmat4(1), offset) * turn * glm::scale(glm::dmat4(1), glm::dvec3(eye.scale));
    return eye;
}

}  // namespace

TEST_CASE("bounds cull no surfel that setup keeps and promise none that it leaves out") {
    Tally tally;
    Random random(11);
    for (int round = 0; round < 6000; ++round) {
        CAPTURE(round);
        const std::vector<format::Surfel> surfels = cloud(random);
        compare(surfels, eye_anywhere(random), tally);
    }
    // And they find most of what there is to find.
    CAPTURE(tally.none, tally.really_none, tally.all, tally.really_all);
    CHECK(tally.none > 0.8 * tally.really_none);
    CHECK(tally.all > 0.6 * tally.really_all);
    CHECK(tally.all > 1000);
}

TEST_CASE("at the horizon, the sides of the picture and the near plane bounds are in doubt") {
    Random random(5);
    Tally tally;
    for (int round = 0; round < 3000; ++round) {
        CAPTURE(round);
        Eye eye;
        eye.camera.orthographic = round % 3 == 0;
        eye.camera.near_plane = 0.01;
        eye.camera.fov_y_degrees = 60;
        // One kind of surfels, so near the limit that rounding decides on which side they are.
        const double off = random.chance(0.3) ? 0 : random.within(-1, 1) * std::pow(10, random.within(-8, -2));
        glm::dvec3 place(random.within(-0.3, 0.3), random.within(-0.2, 0.2), -random.within(1, 3));
        glm::dvec3 normal(0, 0, 1);
        // From the nearest of them, where the limit is, to the middle of the ball: off the side or the near plane.
        glm::dvec3 beyond(0);
        const double pixels = pixel_scale(eye.camera, kHeight);
        if (round % 2 == 0) {
            const glm::dvec3 to_eye = eye.camera.orthographic ? glm::dvec3(0, 0, 1) : glm::normalize(-place);
            const glm::dvec3 across = glm::normalize(glm::cross(to_eye, random.direction()));
            const double angle = std::acos(kHorizon) + off;
            normal = std::cos(angle) * to_eye + std::sin(angle) * across;
        } else if (round % 4 == 1) {
            const double half = (0.5 * kWidth + kSetupReach) / pixels;
            place.x = (half + off) * (eye.camera.orthographic ? 1 : -place.z);
            beyond = eye.camera.orthographic ? glm::dvec3(1, 0, 0) : glm::normalize(glm::dvec3(1, 0, half));
        } else {
            place.z = -eye.camera.near_plane * (1 + off);
            beyond = {0, 0, 1};
        }
        beyond *= random.chance(0.5) ? 0 : random.within(0, 0.3);
        eye.model_to_view = glm::translate(glm::dmat4(1), place + beyond);
        const float radius = random.chance(0.5) ? 0 : 1e-3f;
        std::vector<format::Surfel> surfels;
        for (std::uint32_t i = 0; i < kBoundedSurfels; ++i)
            surfels.push_back(surfel_at(glm::vec3(i % 2 == 0 ? beyond : -beyond), glm::vec3(normal), radius));
        compare(surfels, eye, tally);
    }
    CHECK(tally.none > 100);
    CHECK(tally.all > 100);
}

TEST_CASE("surfels that face all ways, or are no numbers, are never culled for that") {
    Eye eye;
    eye.camera.near_plane = 0.01;
    eye.model_to_view = glm::translate(glm::dmat4(1), glm::dvec3(0, 0, -3));
    std::vector<format::Surfel> surfels;
    for (std::uint32_t i = 0; i < kBoundedSurfels; ++i)
        surfels.push_back(surfel_at(glm::vec3(0), {0, 0, i % 2 == 0 ? 1.0f : -1.0f}, 0.01f));
    CHECK(sight_from(eye).of(bounds_of(surfels).front()) == Sight::kSome);
    for (format::Surfel& surfel : surfels)
        surfel = surfel_at(glm::vec3(0), {0, 0, -1}, 0.01f);
    CHECK(sight_from(eye).of(bounds_of(surfels).front()) == Sight::kNone);
    surfels[7].position[1] = std::numeric_limits<float>::quiet_NaN();
    CHECK(sight_from(eye).of(bounds_of(surfels).front()) == Sight::kSome);
    surfels[7].position[1] = std::numeric_limits<float>::infinity();
    CHECK(sight_from(eye).of(bounds_of(surfels).front()) == Sight::kSome);
}

TEST_CASE("bounds go on behind a model's own surfels") {
    Random random(3);
    const std::vector<format::Surfel> all = cloud(random);
    Model model;
    model.surfels.assign(all.begin(), all.begin() + 100);
    const std::vector<SurfelBounds> together = bounds_of(all);
    const std::vector<SurfelBounds> in_two = bound_surfels(view_of(model), std::span(all).subspan(100));
    REQUIRE(in_two.size() == together.size());
    for (std::size_t i = 0; i < together.size(); ++i) {
        CHECK(in_two[i].centre == together[i].centre);
        CHECK(in_two[i].radius == together[i].radius);
        CHECK(in_two[i].axis == together[i].axis);
        CHECK(in_two[i].spread_cosine == together[i].spread_cosine);
    }
}
