#include "preprocess/mesh/triangulate.h"

#include <catch2/catch.hpp>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <random>

using namespace splice;

namespace {

using Polygon = std::vector<Vec3d>;

std::vector<std::array<std::uint32_t, 3>> triangulate(const Polygon& polygon) {
    std::vector<std::array<std::uint32_t, 3>> triangles;
    triangulate_polygon(polygon, triangles);
    return triangles;
}

Vec3d area_vector(const Polygon& polygon) {
    Vec3d sum = Vec3d::Zero();
    for (std::size_t i = 0; i < polygon.size(); ++i)
        sum += polygon[i].cross(polygon[(i + 1) % polygon.size()]);
    return sum / 2;
}

/// n - 2 triangles, all facing the polygon's way, that add up to its area: for a flat polygon that means they cover it
/// exactly once.
void check_covers(const Polygon& polygon) {
    const auto triangles = triangulate(polygon);
    REQUIRE(triangles.size() == polygon.size() - 2);
    const Vec3d whole = area_vector(polygon);
    double sum = 0;
    bool all_face_forward = true;
    for (const auto& t : triangles) {
        const Vec3d area = (polygon[t[1]] - polygon[t[0]]).cross(polygon[t[2]] - polygon[t[0]]) / 2;
        all_face_forward = all_face_forward && area.dot(whole.normalized()) >= -1e-12;
        sum += area.norm();
    }
    CHECK(all_face_forward);
    CHECK(sum == Approx(whole.norm()).epsilon(1e-9));
}

/// Star-shaped around the origin with random radii: mostly concave.
Polygon random_star(std::size_t corners, unsigned seed) {
    std::mt19937 random(seed);
    Polygon polygon;
    for (std::size_t i = 0; i < corners; ++i) {
        const double angle = 2 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(corners);
        const double radius = 0.2 + static_cast<double>(random() % 1000) / 1000;
        polygon.emplace_back(radius * std::cos(angle), radius * std::sin(angle), 0);
    }
    return polygon;
}

}  // namespace

TEST_CASE("Concave quads are split through the reflex corner, whichever it is") {
    const Polygon arrow = {{0, 0, 0}, {2, 1, 0}, {0, 2, 0}, {0.5, 1, 0}};
    for (std::size_t shift = 0; shift < 4; ++shift) {
        Polygon turned;
        for (std::size_t i = 0; i < 4; ++i)
            turned.push_back(arrow[(i + shift) % 4]);
        check_covers(turned);
    }
}

TEST_CASE("Concave polygons are covered exactly once, in any plane and winding") {
    for (unsigned seed = 0; seed < 30; ++seed) {
        Polygon polygon = random_star(5 + seed * 7, seed);
        check_covers(polygon);
        Polygon reversed(polygon.rbegin(), polygon.rend());
        check_covers(reversed);
        const Eigen::Quaterniond turn(Eigen::AngleAxisd(seed * 0.7, Vec3d(1, seed % 3, 0.5).normalized()));
        for (Vec3d& p : polygon)
            p = turn * p + Vec3d(3, -2, 1);
        check_covers(polygon);
    }
}

TEST_CASE("Spirals and combs are covered exactly once") {
    Polygon spiral;
    const auto arm = [&](double radius_shift, int i) {
        const double angle = 0.1 * i, radius = 0.1 * angle + radius_shift;
        spiral.emplace_back(radius * std::cos(angle), radius * std::sin(angle), 0);
    };
    for (int i = 0; i < 200; ++i)
        arm(0.3, i);
    for (int i = 199; i >= 0; --i)
        arm(0.05, i);
    check_covers(spiral);

    Polygon comb = {{0, -1, 0}, {100, -1, 0}};
    for (int tooth = 99; tooth >= 0; --tooth) {
        comb.emplace_back(tooth + 0.9, 5, 0);
        comb.emplace_back(tooth + 0.5, 0, 0);
    }
    check_covers(comb);
}

TEST_CASE("Holes joined to the rim by a bridge stay holes") {
    // A square with a square hole; the bridge runs from corner 0 to the hole and back.
    check_covers(
        {{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {0, 4, 0}, {0, 0, 0}, {1, 1, 0}, {1, 3, 0}, {3, 3, 0}, {3, 1, 0}, {1, 1, 0}});
    // Two holes, both reached from the same corner.
    check_covers({{0, 0, 0},
                  {9, 0, 0},
                  {9, 4, 0},
                  {0, 4, 0},
                  {0, 0, 0},
                  {1, 1, 0},
                  {1, 3, 0},
                  {3, 3, 0},
                  {3, 1, 0},
                  {1, 1, 0},
                  {0, 0, 0},
                  {5, 1, 0},
                  {5, 3, 0},
                  {7, 3, 0},
                  {7, 1, 0},
                  {5, 1, 0}});
}

TEST_CASE("Polygons with collinear and repeated corners keep their area") {
    check_covers({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {2, 1, 0}, {2, 2, 0}, {1, 2, 0}, {0, 2, 0}, {0, 1, 0}});
    check_covers({{0, 0, 0}, {2, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}});
}

TEST_CASE("Polygons that are not simple get their triangles all the same, and soon") {
    std::mt19937 random(7);
    Polygon scribble;
    for (int i = 0; i < 20000; ++i) {
        scribble.emplace_back(static_cast<double>(random() % 100000), static_cast<double>(random() % 100000), 0);
    }
    CHECK(triangulate(scribble).size() == scribble.size() - 2);
    CHECK(triangulate(Polygon(100, Vec3d(1, 2, 3))).size() == 98);
    Polygon line;
    for (int i = 0; i < 100; ++i)
        line.emplace_back(i % 17, i % 17, i % 17);
    CHECK(triangulate(line).size() == 98);
}
