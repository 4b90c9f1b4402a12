// Meshes and patches that surfel tests sample.
#pragma once

#include "preprocess/mesh/read_mesh.h"
#include "preprocess/mesh/shapes.h"
#include "preprocess/surfel/surfel_set.h"

#include <string>
#include <vector>

namespace splice::test {

struct NamedMesh {
    std::string name;
    IndexedMesh mesh;
};

IndexedMesh repaired(SourceMesh source);

/// Repaired; coordinates are scaled to the unit box.
IndexedMesh mesh_of(const std::vector<Vec3d>& positions, const std::vector<Triangle>& triangles);

/// Shapes that samplers get wrong: slivers, wedges, borders, non-manifold edges, sizes far apart.
std::vector<NamedMesh> awkward_meshes();

/// Every triangle in one surfel patch.
PatchSet one_patch(const IndexedMesh& mesh);

/// Triangles by the cell of a coarse grid their centroid is in; all surfel patches, or every other one.
PatchSet patches_by_cell(const IndexedMesh& mesh, int cells, bool every_other = false);

}  // namespace splice::test
