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

TEST_CASE("an ellipse of points on a line has width, and one of one point is a circle") {
    Matrix2d line;
    line << 0, 0, 0, 4;
    const Ellipse ellipse = ellipse_of(line);
    CHECK(std::abs(ellipse.axis.y()) == Approx(1));
    CHECK(ellipse.major == Approx(2));
    CHECK(ellipse.minor == Approx(0.5));
    CHECK(ellipse_of(Matrix2d::Zero()).minor == 1);
}

TEST_CASE("the factor makes an ellipse hold the disk, and not much more") {
    std::mt19937 random(5);
    std::uniform_real_distribution<double> uniform(-1, 1);
    for (int round = 0; round < 200; ++round) {
        Ellipse ellipse;
        const double angle = 3 * uniform(random);
        ellipse.axis = {std::cos(angle), std::sin(angle)};
        ellipse.major = 2;
        ellipse.minor = 0.5 + std::abs(uniform(random));
        const Vector2d centre(3 * uniform(random), 3 * uniform(random));
        const double radius = std::abs(uniform(random));
        const double factor = factor_to_hold(ellipse, centre, radius, radius);
        const Vector2d across(-ellipse.axis.y(), ellipse.axis.x());
        double needed = 0;
        for (int i = 0; i < 256; ++i) {
            const Vector2d rim = centre + radius * Vector2d(std::cos(i * 0.0245437), std::sin(i * 0.0245437));
            needed =
                std::max(needed, std::hypot(rim.dot(ellipse.axis) / ellipse.major, rim.dot(across) / ellipse.minor));
        }
        CHECK(factor >= needed - 1e-9);
        CHECK(factor <= 1.45 * needed);  // sqrt 2 where it is the rectangle's corner that counts
    }
}
