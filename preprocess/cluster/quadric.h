// Additive O(1) summaries of a cluster (Ni 2005, 3.2.2, after Garland, Willmott and Heckbert 2001): the summary of a
// union is the sum of the summaries, and the errors follow from it without looking at faces again. Double precision;
// points are inside the unit box, so the covariance loses at most some 1e-16 to cancellation.
#pragma once

#include "preprocess/mesh/indexed_mesh.h"

#include <Eigen/Core>
#include <Eigen/Eigenvalues>
#include <cmath>

namespace splice {

struct Plane {
    Vec3d normal;   // unit
    double offset;  // normal . x + offset = 0
};

/// Symmetric 3x3 matrix: xx, xy, xz, yy, yz, zz.
struct Symmetric3 {
    double xx = 0, xy = 0, xz = 0, yy = 0, yz = 0, zz = 0;

    /// w * v v^T
    static Symmetric3 outer(const Vec3d& v, double w) {
        return {w * v.x() * v.x(), w * v.x() * v.y(), w * v.x() * v.z(),
                w * v.y() * v.y(), w * v.y() * v.z(), w * v.z() * v.z()};
    }
    Symmetric3& operator+=(const Symmetric3& o) {
        xx += o.xx, xy += o.xy, xz += o.xz, yy += o.yy, yz += o.yz, zz += o.zz;
        return *this;
    }
    /// v^T M v
    double form(const Vec3d& v) const {
        return xx * v.x() * v.x() + yy * v.y() * v.y() + zz * v.z() * v.z() +
               2 * (xy * v.x() * v.y() + xz * v.x() * v.z() + yz * v.y() * v.z());
    }
};

/// Point quadric P = (A, b, c) = (sum v v^T, sum v, k) (eq. 3.11, 3.12).
struct PointQuadric {
    Symmetric3 a;
    Vec3d b = Vec3d::Zero();
    double c = 0;

    static PointQuadric of(const Vec3d& v) { return {Symmetric3::outer(v, 1), v, 1}; }
    PointQuadric& operator+=(const PointQuadric& o) {
        a += o.a;
        b += o.b;
        c += o.c;
        return *this;
    }

    /// E_fit: the mean squared distance to a plane (eq. 3.9 with n^T v for its n v^T).
    double mean_squared_distance(const Plane& plane) const {
        return std::max(
            0.0, (a.form(plane.normal) + 2 * plane.offset * b.dot(plane.normal) + plane.offset * plane.offset * c) / c);
    }

    /// Least-squares plane (eq. 3.13): through the mean, along the eigenvector of the covariance's smallest eigenvalue.
    /// The normal's sign is chosen to agree with `towards`.
    Plane best_fit(const Vec3d& towards) const {
        const Vec3d mean = b / c;
        Eigen::Matrix3d covariance;
        covariance << a.xx, a.xy, a.xz, a.xy, a.yy, a.yz, a.xz, a.yz, a.zz;
        covariance = covariance / c - mean * mean.transpose();
        // Closed form; scaled, because it compares against absolute tolerances.
        const double scale = covariance.diagonal().sum();
        Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
        if (scale > 0) covariance /= scale;
        solver.computeDirect(covariance);
        Vec3d normal = solver.eigenvectors().col(0);
        if (normal.dot(towards) < 0) normal = -normal;
        return {normal, -normal.dot(mean)};
    }
};

/// Area-weighted direction quadric: the sums that make E_dir O(1).
struct DirectionQuadric {
    Symmetric3 a;             // sum w n n^T
    Vec3d b = Vec3d::Zero();  // sum w n; its direction is the mean normal
    double c = 0;             // sum w

    static DirectionQuadric of(const Vec3d& n, double w) { return {Symmetric3::outer(n, w), w * n, w}; }
    DirectionQuadric& operator+=(const DirectionQuadric& o) {
        a += o.a;
        b += o.b;
        c += o.c;
        return *this;
    }

    /// E_dir = (1/w) sum w_i (1 - n . n_i)^2 (eq. 3.14, area weighted). Orient n with the mean normal first.
    double deviation(const Vec3d& n) const { return std::max(0.0, (c - 2 * b.dot(n) + a.form(n)) / c); }
};

}  // namespace splice
