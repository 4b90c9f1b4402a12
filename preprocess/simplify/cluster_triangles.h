// An order of triangles in which runs of so many lie together and face the same way, so that a renderer that bounds the
// runs can leave out those that face away or lie outside the picture without a look at any triangle.
#pragma once

#include "preprocess/mesh/indexed_mesh.h"

#include <span>
#include <vector>

namespace splice {

/// Triangles of a run; the last may have fewer.
inline constexpr std::size_t kClusterTriangles = 64;

struct ClusteredTriangle {
    Vec3f centroid, normal;  // unit, or zero
    float area;
};
ClusteredTriangle clustered_triangle(const Vec3f& a, const Vec3f& b, const Vec3f& c);

/// Of the triangles' indices. Those of a run ascend.
std::vector<std::uint32_t> cluster_order(std::span<const ClusteredTriangle> triangles);

}  // namespace splice
