#include "preprocess/cloud/least_spread.h"
#include "tests/cloud/cloud_shapes.h"

#include <catch2/catch.hpp>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <random>

using namespace splice;

namespace {

Eigen::Matrix3d matrix_of(const Vec3d& eigenvalues, const Eigen::Quaterniond& turn) {
    const Eigen::Matrix3d axes = turn.toRotationMatrix();
    return axes * eigenvalues.asDiagonal() * axes.transpose();
}

}  // namespace

TEST_CASE("the direction of least spread is the eigenvector that Eigen's iteration finds") {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> share(0, 1);
    for (int i = 0; i < 2000; ++i) {
        const Eigen::Quaterniond turn =
            Eigen::Quaterniond(share(random) - 0.5, share(random) - 0.5, share(random) - 0.5, share(random) - 0.5)
                .normalized();
        const double scale = std::pow(10.0, -12 * share(random)), flat = std::pow(10.0, -9 * share(random));
        const Eigen::Matrix3d m = matrix_of(scale * Vec3d(0.05 * flat, 0.1 + share(random), 1.5), turn);
        const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(m);
        const LeastSpread found = least_spread(m);
        CHECK(std::abs(found.direction.dot(solver.eigenvectors().col(0))) > 1 - 1e-9);
        CHECK(found.direction.norm() == Approx(1));
        CHECK(found.middle == Approx(solver.eigenvalues()[1]));
        CHECK(found.most == Approx(solver.eigenvalues()[2]));
    }
}

TEST_CASE("where several directions spread least, one of them is found") {
    const Eigen::Quaterniond turn = Eigen::Quaterniond(0.3, 0.2, -0.7, 0.4).normalized();
    const Vec3d line = turn * Vec3d::UnitZ();
    const LeastSpread of_line = least_spread(matrix_of({0, 0, 1e-6}, turn));
    CHECK(std::abs(of_line.direction.dot(line)) < 1e-6);
    CHECK(of_line.middle <= 1e-15);
    CHECK(of_line.most == Approx(1e-6));
    const LeastSpread of_ball = least_spread(matrix_of({2, 2, 2}, turn));
    CHECK(of_ball.direction.norm() == Approx(1));
    CHECK(of_ball.middle == Approx(2));
    const LeastSpread of_point = least_spread(Eigen::Matrix3d::Zero());
    CHECK(of_point.direction.norm() == Approx(1));
    CHECK(of_point.most == 0);
}
