// Meshes and divisions into patches for the simplifier's tests, with no clustering involved.
#pragma once

#include "preprocess/cluster/patch_set.h"

#include <functional>

namespace splice::test {

/// A height field over [-0.5, 0.5]^2 with `cells` x `cells` squares of two triangles.
IndexedMesh height_field(unsigned cells, const std::function<float(float x, float y)>& height);

/// A closed, bumpy sphere: a subdivided octahedron.
IndexedMesh bumpy_sphere(unsigned subdivisions, float bump);

/// A hub with `spokes` triangles around it.
IndexedMesh fan(unsigned spokes);

/// A mesh as it would come out of repair, with smooth normals.
IndexedMesh mesh_of(std::vector<Vec3f> positions, std::vector<Triangle> triangles);

/// `label` names the patch of a triangle; labels are 0, 1, 2, ... without gaps.
PatchSet divide(const IndexedMesh& mesh, const std::function<std::uint32_t(std::uint32_t triangle)>& label);

Vec3f centroid(const IndexedMesh& mesh, std::uint32_t triangle);

}  // namespace splice::test
