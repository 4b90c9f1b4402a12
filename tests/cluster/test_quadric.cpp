#include "preprocess/cluster/quadric.h"
#include "preprocess/cluster/shape.h"

#include <catch2/catch.hpp>

#include <Eigen/Geometry>
#include <numbers>
#include <random>
#include <vector>

using namespace splice;

namespace {

class Random {
  public:
    explicit Random(std::uint32_t seed) : engine_(seed) {}
    double unit() { return static_cast<double>(engine_()) / 4294967296.0 - 0.5; }
    Vec3d point() {
        const double x = unit(), y = unit(), z = unit();
        return {x, y, z};
    }

  private:
    std::mt19937 engine_;
};

double direct_mean_squared_distance(const std::vector<Vec3d>& points, const Plane& plane) {
    double sum = 0;
    for (const Vec3d& p : points)
        sum += std::pow(plane.normal.dot(p) + plane.offset, 2);
    return sum / static_cast<double>(points.size());
}

}  // namespace

TEST_CASE("E_fit from the point quadric equals the sum over all points") {
    Random random(1);
    for (int round = 0; round < 50; ++round) {
        std::vector<Vec3d> points;
        // Small and far off centre, where cancellation would show.
        const Vec3d centre = random.point();
        PointQuadric first, second;
        for (int i = 0; i < 40; ++i) {
            points.push_back(centre + 0.01 * random.point());
            (i < 13 ? first : second) += PointQuadric::of(points.back());
        }
        PointQuadric sum = first;
        sum += second;
        const Vec3d normal = random.point().normalized();
        const Plane plane{normal, -normal.dot(points[7])};
        CHECK(sum.mean_squared_distance(plane) == Approx(direct_mean_squared_distance(points, plane)).epsilon(1e-6));
    }
}

TEST_CASE("The plane from the point quadric is the least-squares plane, turned as asked") {
    Random random(2);
    for (int round = 0; round < 50; ++round) {
        const Vec3d centre = random.point(), normal = random.point().normalized();
        const Vec3d u = normal.unitOrthogonal(), v = normal.cross(u);
        std::vector<Vec3d> points;
        PointQuadric quadric;
        for (int i = 0; i < 30; ++i) {
            points.push_back(centre + 0.05 * (random.unit() * u + random.unit() * v + 0.05 * random.unit() * normal));
            quadric += PointQuadric::of(points.back());
        }
        const Plane plane = quadric.best_fit(normal);
        CHECK(plane.normal.norm() == Approx(1));
        CHECK(plane.normal.dot(normal) > 0.9);
        CHECK(quadric.best_fit(-normal).normal.dot(normal) < -0.9);
        const double least = direct_mean_squared_distance(points, plane);
        for (int i = 0; i < 20; ++i) {
            const Plane other{(plane.normal + 0.02 * random.point()).normalized(), 0};
            const Vec3d mean = quadric.b / quadric.c;
            CHECK(direct_mean_squared_distance(points, {other.normal, -other.normal.dot(mean)}) >= least);
        }
    }
}

TEST_CASE("Points on a line or in one place have a plane too") {
    PointQuadric line, place;
    for (int i = 0; i < 5; ++i) {
        line += PointQuadric::of(Vec3d(0.1 * i, 0, 0));
        place += PointQuadric::of(Vec3d(0.3, -0.2, 0.1));
    }
    for (const PointQuadric& quadric : {line, place}) {
        const Plane plane = quadric.best_fit(Vec3d::UnitZ());
        CHECK(plane.normal.norm() == Approx(1));
        CHECK(quadric.mean_squared_distance(plane) == Approx(0).margin(1e-12));
    }
}

TEST_CASE("E_dir from the direction quadric equals the weighted sum over all faces") {
    Random random(3);
    for (int round = 0; round < 50; ++round) {
        DirectionQuadric quadric;
        std::vector<std::pair<Vec3d, double>> faces;
        double weight = 0;
        for (int i = 0; i < 25; ++i) {
            faces.emplace_back((Vec3d::UnitZ() + random.point()).normalized(), random.unit() + 0.6);
            quadric += DirectionQuadric::of(faces.back().first, faces.back().second);
            weight += faces.back().second;
        }
        const Vec3d normal = quadric.b.normalized();
        double sum = 0;
        for (const auto& [n, w] : faces)
            sum += w * std::pow(1 - normal.dot(n), 2);
        CHECK(quadric.deviation(normal) == Approx(sum / weight).epsilon(1e-9));
    }
}

TEST_CASE("E_shape is negative when a merge makes a rounder cluster and positive when it makes a longer one") {
    const Shape square{1, 4}, two_by_one = united(square, square, 1);
    CHECK(two_by_one.area == Approx(2));
    CHECK(two_by_one.perimeter == Approx(6));
    CHECK(square.irregularity() == Approx(4 / std::numbers::pi));
    CHECK(shape_cost(two_by_one.irregularity(), square.irregularity(), square.irregularity()) > 0);
    const Shape two_by_two = united(two_by_one, two_by_one, 2);
    CHECK(shape_cost(two_by_two.irregularity(), two_by_one.irregularity(), two_by_one.irregularity()) < 0);
}

TEST_CASE("A closed cluster, which has no perimeter, counts as round") {
    CHECK(united({1, 4}, {1, 4}, 4).irregularity() == 1);
    CHECK(united({1, 4}, {1, 4}, 4.0001f).irregularity() == 1);
}
