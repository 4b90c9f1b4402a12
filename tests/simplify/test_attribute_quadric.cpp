#include "preprocess/simplify/attribute_quadric.h"

#include <catch2/catch.hpp>

using namespace splice;

namespace {

using Attributes = AttributeQuadric::Attributes;

constexpr std::size_t kCount = 2;

// Linear over space, as those of a smooth surface are nearly.
Attributes linear(const Vec3d& p) {
    return {0.3 + 2 * p.x() - p.y(), 1 - 0.5 * p.x() + 3 * p.y()};
}

AttributeQuadric triangle(const Vec3d& a, const Vec3d& b, const Vec3d& c, double width = 0) {
    AttributeQuadric quadric;
    quadric.add_triangle({a, b, c}, {linear(a), linear(b), linear(c)}, kCount, width);
    return quadric;
}

}  // namespace

TEST_CASE("attributes that are linear over a plane cost nothing anywhere on it, and are found there") {
    AttributeQuadric quadric = triangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
    quadric += triangle({1, 0, 0}, {1.5, 2, 0}, {0, 1, 0});
    CHECK(quadric.weight() == Approx(0.5 + 1.25));
    for (const Vec3d& place : {Vec3d(0, 0, 0), Vec3d(0.4, 0.7, 0), Vec3d(-3, 5, 0)}) {
        CHECK(quadric.difference(place, kCount) == Approx(0).margin(1e-9));
        CHECK(quadric.distance(place) == Approx(0).margin(1e-12));
        const Attributes found = quadric.best(place, kCount), expected = linear(place);
        for (std::size_t i = 0; i < kCount; ++i)
            CHECK(found[i] == Approx(expected[i]));
    }
    CHECK(quadric.distance({0.3, 0.2, 2}) == Approx(4 * 1.75));
}

TEST_CASE("a step of attributes costs its variance, by area") {
    AttributeQuadric quadric;
    const std::array<Vec3d, 3> here{Vec3d(0, 0, 0), Vec3d(1, 0, 0), Vec3d(0, 1, 0)};
    Attributes low{}, high{};
    low[0] = 1, high[0] = 4;
    quadric.add_triangle(here, {low, low, low}, kCount, 0.1);
    quadric.add_triangle({here[0], here[2], Vec3d(-2, 0, 0)}, {high, high, high}, kCount, 0.1);
    // Areas 0.5 and 1: mean 3, 0.5 * 2^2 + 1 * 1^2.
    CHECK(quadric.best({0, 0, 0}, kCount)[0] == Approx(3));
    CHECK(quadric.difference({0, 0, 0}, kCount) == Approx(3));
}

TEST_CASE("a plane alone holds a border in place and stands for no surface") {
    AttributeQuadric quadric;
    quadric.add_plane({1, 0, 0}, {2, 0, 0}, 3);
    CHECK(quadric.weight() == 0);
    CHECK(quadric.distance({4, 7, 7}) == Approx(3 * 4));
    CHECK(quadric.difference({4, 7, 7}, kCount) == 0);
    CHECK(quadric.best({4, 7, 7}, kCount)[0] == 0);
}

// Its attributes differ by noise over next to no distance.
TEST_CASE("a sliver's attributes do not prevail a width away") {
    const double thin = 1e-5;
    const std::array<Vec3d, 3> sliver{Vec3d(0, 0, 0), Vec3d(1, 0, 0), Vec3d(0.5, thin, 0)};
    Attributes even{}, off{};
    even[0] = 1, off[0] = -1;
    AttributeQuadric quadric;
    quadric.add_triangle({Vec3d(0, 0, 0), Vec3d(1, 0, 0), Vec3d(0, -1, 0)}, {even, even, even}, kCount, 0.1);
    quadric.add_triangle(sliver, {even, even, off}, kCount, 0.1);
    CHECK(quadric.best({0.3, 0.5, 0}, kCount)[0] == Approx(1).margin(1e-3));
    CHECK(quadric.difference({0.3, 0.5, 0}, kCount) < 1e-3);
}
