#include "preprocess/lod/bounding_ellipse.h"
#include "preprocess/lod/homogeneous_covariance.h"

#include <catch2/catch.hpp>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <random>
#include <vector>

using namespace splice;
using Eigen::Matrix2d;
using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

namespace {

std::vector<Vector3d> random_points(std::size_t count, unsigned seed, const Vector3d& centre, double spread) {
    std::mt19937 random(seed);
    std::normal_distribution<double> normal;
    std::vector<Vector3d> points(count);
    for (Vector3d& point : points)
        point = centre + spread * Vector3d(3 * normal(random), normal(random), 0.1 * normal(random));
    return points;
}

// Equation (1) of the paper.
Matrix3d direct_covariance(const std::vector<Vector3d>& points, const Vector3d& centre) {
    Matrix3d sum = Matrix3d::Zero();
    for (const Vector3d& point : points)
        sum += (point - centre) * (point - centre).transpose();
    return sum / static_cast<double>(points.size());
}

HomogeneousCovariance covariance_of(const std::vector<Vector3d>& points) {
    HomogeneousCovariance covariance;
    for (const Vector3d& point : points)
        covariance.add(point);
    return covariance;
}

}  // namespace

TEST_CASE("the homogeneous covariance is the direct one about any centre") {
    const auto points = random_points(1000, 1, {0.3, -0.2, 0.4}, 0.01);
    const HomogeneousCovariance covariance = covariance_of(points);
    CHECK(covariance.count() == 1000);
    for (const Vector3d& centre : {covariance.mean(), Vector3d(0, 0, 0), Vector3d(0.31, -0.2, 0.5)}) {
        const Matrix3d direct = direct_covariance(points, centre);
        CHECK((covariance.about(centre) - direct).norm() <= 1e-12 * (1 + direct.norm()));
    }
}

TEST_CASE("a union's covariance is the sum of its parts'") {
    const auto all = random_points(700, 2, {0, 0.1, 0}, 0.1);
    const std::vector<Vector3d> first(all.begin(), all.begin() + 250), second(all.begin() + 250, all.end());
    HomogeneousCovariance sum = covariance_of(first);
    sum += covariance_of(second);
    const Matrix3d direct = direct_covariance(all, sum.mean());
    CHECK((sum.about(sum.mean()) - direct).norm() < 1e-12 * direct.norm());
}

TEST_CASE("small far clusters keep their covariance in double precision") {
    // A ten-thousandth of the unit box, at its corner: what a node of a few points of a scan looks like.
    const auto points = random_points(50, 3, {0.5, 0.5, 0.5}, 1e-4);
    const HomogeneousCovariance covariance = covariance_of(points);
    const Matrix3d direct = direct_covariance(points, covariance.mean());
    CHECK((covariance.about(covariance.mean()) - direct).norm() < 1e-6 * direct.norm());
}

TEST_CASE("the covariance in a plane is that of the projected points") {
    const auto points = random_points(300, 4, {0.1, 0.2, 0.3}, 0.05);
    const Vector3d n = Vector3d(1, 2, 3).normalized(), s = n.unitOrthogonal(), t = n.cross(s);
    const HomogeneousCovariance covariance = covariance_of(points);
    const Vector3d centre = covariance.mean();
    Matrix2d direct = Matrix2d::Zero();
    for (const Vector3d& point : points) {
        const Vector2d q(s.dot(point - centre), t.dot(point - centre));
        direct += q * q.transpose() / 300;
    }
    CHECK((covariance.in_plane(centre, s, t) - direct).norm() < 1e-12);
}

TEST_CASE("an ellipse has the axes of its covariance, square roots of the eigenvalues") {
    Matrix2d covariance;
    covariance << 5, 2, 2, 3;
    const Eigen::SelfAdjointEigenSolver<Matrix2d> solver(covariance);
    const Ellipse ellipse = ellipse_of(covariance);
    CHECK(ellipse.major == Approx(std::sqrt(solver.eigenvalues()[1])));
    CHECK(ellipse.minor == Approx(std::sqrt(solver.eigenvalues()[0])));
    CHECK(std::abs(ellipse.axis.dot(solver.eigenvectors().col(1))) == Approx(1));
}

TEST_CASE("an ellipse of points on a line has no width, and one of one point no length") {
    Matrix2d line;
    line << 0, 0, 0, 4;
    const Ellipse ellipse = ellipse_of(line);
    CHECK(std::abs(ellipse.axis.y()) == Approx(1));
    CHECK(ellipse.major == Approx(2));
    CHECK(ellipse.minor == 0);
    CHECK(ellipse_of(Matrix2d::Zero()).major == 0);
}

TEST_CASE("an ellipse holds its disks, and is hardly longer than their circle and never larger") {
    std::mt19937 random(5);
    std::uniform_real_distribution<double> uniform(-1, 1);
    for (int round = 0; round < 200; ++round) {
        std::vector<Footprint> disks;
        const double flatness = std::abs(uniform(random));
        for (int i = 0; i <= round % 20; ++i) {
            const double radius = 0.3 * std::abs(uniform(random));
            disks.push_back({uniform(random), flatness * uniform(random), radius, radius, radius});
        }
        const Ellipse ellipse = ellipse_around(disks);
        double circle = 0, farthest = 0;
        for (const Footprint& disk : disks) {
            circle = std::max(circle, std::hypot(disk.x, disk.y) + disk.radius);
            for (int i = 0; i < 256; ++i) {
                const double x = disk.x + disk.radius * std::cos(i * 0.0245437),
                             y = disk.y + disk.radius * std::sin(i * 0.0245437);
                farthest = std::max(farthest, std::hypot(x / ellipse.major, y / ellipse.minor));
            }
        }
        CHECK(farthest <= 1 + 1e-9);
        CHECK(ellipse.minor <= ellipse.major);
        CHECK(ellipse.major <= 1.1 * circle * (1 + 1e-9));
        CHECK(ellipse.major * ellipse.minor <= circle * circle * (1 + 1e-9));
    }
}

TEST_CASE("disks in a row make a narrow ellipse") {
    std::vector<Footprint> row;
    for (int i = -10; i <= 10; ++i)
        row.push_back({0.1 * i, 0, 0.05, 0.05, 0.05});
    const Ellipse ellipse = ellipse_around(row);
    CHECK(ellipse.major < 1.2);
    CHECK(ellipse.minor < 0.2);
}
