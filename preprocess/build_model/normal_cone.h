// A cone that holds all normals of a patch, for culling whole patches that face away.
#pragma once

#include "preprocess/mesh/indexed_mesh.h"

#include <algorithm>
#include <span>

namespace splice {

struct NormalCone {
    Vec3f axis = Vec3f::UnitZ();
    float cosine = -1;  // of the half-angle; -1 when the normals point everywhere
};

/// Around the mean of `normals`, which are unit. The cosine is rounded down by 1e-5, so that rounding lets none out.
inline NormalCone enclose_normals(std::span<const Vec3f> normals) {
    Vec3d sum = Vec3d::Zero();
    for (const Vec3f& normal : normals)
        sum += normal.cast<double>();
    NormalCone cone;
    if (sum.norm() < 1e-6) return cone;
    cone.axis = sum.normalized().cast<float>();
    cone.cosine = 1;
    for (const Vec3f& normal : normals)
        cone.cosine = std::min(cone.cosine, normal.dot(cone.axis));
    cone.cosine = std::clamp(cone.cosine - 1e-5f, -1.0f, 1.0f);
    return cone;
}

}  // namespace splice
