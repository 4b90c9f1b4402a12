#include "preprocess/model_format/half.h"
#include "preprocess/model_format/surfel_extent.h"
#include "tests/reference/surfel_tolerance.h"

#include <catch2/catch.hpp>
#include <glm/gtc/matrix_transform.hpp>

using namespace splice;
using namespace splice::reference;

namespace {

/// Ten pixels a unit, 40x40, looking down -z at the origin from distance 5.
ReferenceView orthographic_view() {
    glm::dmat4 projection = glm::ortho(-2.0, 2.0, -2.0, 2.0, 0.1, 10.0);
    projection[1][1] *= -1;
    return {glm::translate(glm::dmat4(1), glm::dvec3(0, 0, -5)), projection, 40, 40};
}

Model one_surfel(float x, float y, float z, float radius, float epsilon) {
    Model model;
    format::Surfel surfel{};
    surfel.position[0] = x;
    surfel.position[1] = y;
    surfel.position[2] = z;
    surfel.radius = half_at_least(radius);
    surfel.extent = encode_extent({0, 0, epsilon}, float_from_half(surfel.radius));
    model.surfels = {surfel};
    return model;
}

}  // namespace

TEST_CASE("a surfel grants its tolerance to the pixels under it and to no others") {
    const ReferenceView view = orthographic_view();
    const Model model = one_surfel(1, 0.5f, 0, 0.3f, 0.3f / 16);
    const DepthImage reference(40, 40, 5.0f);
    const Tolerance tolerance = surfel_tolerance(view_of(model), view, reference, 1.5f, 1e-4f);
    CHECK(tolerance.depth.at(30, 15) == Approx(4 * 0.3 / 16).epsilon(1e-3));  // (2 * 1.5 + 1) epsilon
    CHECK(tolerance.radius_px.at(30, 15) == Approx(3).epsilon(1e-3));
    CHECK(tolerance.depth.at(33, 15) ==
          Approx(4 * 0.3 / 16).epsilon(1e-3));  // 3.5 px from the centre, within radius + 1
    CHECK(tolerance.depth.at(34, 15) == Approx(1e-4));
    CHECK(tolerance.radius_px.at(34, 15) == 0);
    CHECK(tolerance.depth.at(9, 24) == Approx(1e-4));
}

TEST_CASE("a surfel behind the reference grants nothing, one before nothing grants its radius") {
    const ReferenceView view = orthographic_view();
    const Model model = one_surfel(0, 0, -3, 0.3f, 0.02f);
    DepthImage reference(40, 40, 5.0f);
    reference.at(20, 20) = kNothing;
    const Tolerance tolerance = surfel_tolerance(view_of(model), view, reference, 1, 1e-4f);
    CHECK(tolerance.depth.at(19, 19) == Approx(1e-4));
    CHECK(tolerance.radius_px.at(20, 20) == Approx(3).epsilon(1e-3));
}

TEST_CASE("tolerances follow perspective and the scale of the instance") {
    glm::dmat4 projection = glm::perspective(glm::radians(90.0), 1.0, 0.1, 100.0);
    projection[1][1] *= -1;
    const ReferenceView view{
        glm::translate(glm::dmat4(1), glm::dvec3(0, 0, -4)) * glm::scale(glm::dmat4(1), glm::dvec3(2)), projection, 80,
        80};
    const Model model = one_surfel(0, 0, 0, 0.1f, 0.025f);
    const DepthImage reference(80, 80, 4.0f);
    const Tolerance tolerance = surfel_tolerance(view_of(model), view, reference, 1, 1e-4f);
    CHECK(tolerance.depth.at(40, 40) == Approx(3 * 0.025 * 2).epsilon(1e-3));
    // 40 pixels a unit at depth 1; the disk's nearest point bounds it.
    CHECK(tolerance.radius_px.at(40, 40) == Approx(0.2 * 40 / 3.8).epsilon(1e-3));
}
