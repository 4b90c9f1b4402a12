// The direction in which points spread least: the eigenvector of a covariance's smallest eigenvalue.
#pragma once

#include "preprocess/mesh/indexed_mesh.h"

namespace splice {

struct LeastSpread {
    Vec3d direction;                         // unit
    double least = 0, middle = 0, most = 0;  // the eigenvalues, at least 0
};

/// Of a symmetric, positive semidefinite matrix; of its lower triangle nothing is read. Where no direction is least,
/// any of those that are.
LeastSpread least_spread(const Eigen::Matrix3d& covariance);

}  // namespace splice
