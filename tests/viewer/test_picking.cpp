// Rays against models: what is hit, and that the octree hides nothing.
#include "engine/viewer/picking.h"
#include "preprocess/build_model/build_model.h"
#include "preprocess/mesh/shapes.h"

#include <catch2/catch.hpp>

#include <random>

using namespace splice;

namespace {

Model baked(const SourceMesh& source, ForcedRepresentation representation) {
    BakeOptions options;
    options.cluster.representation = representation;
    RepairReport report;
    BakeStats stats;
    return build_model(repair_mesh(source, options.repair, report, "shape"), options, stats);
}

Ray towards(const glm::dvec3& from, const glm::dvec3& to) {
    return {from, glm::normalize(to - from)};
}

}  // namespace

TEST_CASE("a ray meets a sphere of triangles or surfels where the sphere is") {
    for (const auto representation : {ForcedRepresentation::kTriangles, ForcedRepresentation::kSurfels}) {
        const Model model = baked(shapes::ico_sphere(24), representation);
        const ModelView view = view_of(model);
        Transform transform;
        transform.scale = 2;
        transform.translation = {1, 2, 3};
        transform.rotation = glm::dmat3(glm::dvec3(0, 1, 0), glm::dvec3(-1, 0, 0), glm::dvec3(0, 0, 1));
        const PickableModel pickable{&view, transform};
        std::mt19937 random(3);
        std::normal_distribution<double> normal;
        for (int i = 0; i < 200; ++i) {
            const glm::dvec3 outwards = glm::normalize(glm::dvec3(normal(random), normal(random), normal(random)));
            const glm::dvec3 eye = transform.translation + outwards * 7.0;
            const auto hit = pick({&pickable, 1}, towards(eye, transform.translation));
            REQUIRE(hit);
            CHECK(hit->distance == Approx(5).margin(0.02));
            CHECK(glm::length(hit->point - (transform.translation + outwards * 2.0)) < 0.1);
            CHECK(glm::dot(hit->normal, outwards) > 0.9);
            CHECK(hit->patch < model.patches.size());
            const bool surfel = representation == ForcedRepresentation::kSurfels;
            CHECK((hit->kind == format::Representation::kSurfels) == surfel);
            if (surfel) CHECK(model.surfels[hit->element].patch == hit->patch);
            const auto by_triangles =
                pick({&pickable, 1}, towards(eye, transform.translation), {.shown = Shown::kTriangles});
            REQUIRE(by_triangles);
            CHECK(by_triangles->kind == format::Representation::kTriangles);
            CHECK(by_triangles->distance == Approx(5).margin(0.02));
        }
        CHECK_FALSE(pick({&pickable, 1}, towards({1, 2, 10}, {9, 2, 3})));
        CHECK_FALSE(pick({&pickable, 1}, {{1, 2, 10}, {0, 0, 1}}));  // away from it
    }
}

TEST_CASE("from inside, a closed sphere is invisible unless both sides count") {
    const Model model = baked(shapes::ico_sphere(8), ForcedRepresentation::kTriangles);
    const ModelView view = view_of(model);
    const PickableModel pickable{&view, {}};
    const Ray ray{{0, 0, 0}, glm::normalize(glm::dvec3(0.3, 0.5, 0.8))};
    CHECK_FALSE(pick({&pickable, 1}, ray));
    CHECK(pick({&pickable, 1}, ray, {.sides = Sides::kTwoSided}));
    CHECK_FALSE(pick({&pickable, 1}, {{0, 0, 5}, {0, 0, -1}}, {.shown = Shown::kSurfels}));
}

TEST_CASE("of several models the nearest is picked, and named") {
    const Model model = baked(shapes::cube(2), ForcedRepresentation::kTriangles);
    const ModelView view = view_of(model);
    Transform near_one, far_one;
    near_one.translation = {0, 0, 2};
    const std::vector<PickableModel> pickable{{&view, far_one}, {&view, near_one}};
    const auto hit = pick(pickable, {{0.1, 0.05, 10}, {0, 0, -1}});
    REQUIRE(hit);
    CHECK(hit->instance == 1);
    CHECK(hit->point.z == Approx(2.5));
    const auto other = pick(pickable, {{0.1, 0.05, -10}, {0, 0, 1}});
    REQUIRE(other);
    CHECK(other->instance == 0);
    CHECK(other->point.z == Approx(-0.5));
}
