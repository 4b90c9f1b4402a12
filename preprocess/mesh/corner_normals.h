// Vertex normals, split at creases.
#pragma once

#include "preprocess/mesh/edge_table.h"

namespace splice {

/// One unit normal a corner: the mean of the normals of the triangles around the vertex, weighted by their angle there
/// (Thuermer and Wuethrich 1998), over those reached without crossing a crease: an edge whose triangles' normals are
/// more than `crease_angle_degrees` apart, are wound inconsistently, or are not two.
std::vector<Vec3f> compute_corner_normals(std::span<const Vec3f> positions, std::span<const Triangle> triangles,
                                          const EdgeTable& edges, float crease_angle_degrees);

}  // namespace splice
