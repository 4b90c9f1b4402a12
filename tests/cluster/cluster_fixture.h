// Small meshes and the checks that every result of clustering must pass.
#pragma once

#include "preprocess/cluster/cluster_mesh.h"
#include "preprocess/cluster/face_graph.h"
#include "preprocess/mesh/read_mesh.h"

#include <initializer_list>
#include <optional>
#include <string>
#include <vector>

namespace splice::test {

/// Repaired, so that it holds IndexedMesh's invariants.
IndexedMesh repaired(SourceMesh source);

/// From bare positions and triangles, as they are: no repair, scaled into the unit box.
IndexedMesh bare_mesh(const std::vector<Vec3d>& positions, const std::vector<Triangle>& triangles);

/// One of the models of the collection, e.g. "bunny.smf"; nothing (and a message) when the collection is absent.
std::optional<IndexedMesh> collection_mesh(const std::string& name);

/// The faces, in order, and what they adjoin.
FaceGraph graph_of(const IndexedMesh& mesh);

/// A closed wavy sphere of 4 * n * (n - 1) triangles with a poor triangulation, from a fixed random sequence.
IndexedMesh random_blob(std::uint32_t n, std::uint32_t seed);

/// REQUIREs: each triangle in exactly one patch, patches connected over edges of exactly two faces and of one material,
/// areas and normals right, the merge tree a forest whose roots are the patches with each leaf reached once, statistics
/// agreeing with the patches.
void require_sound(const IndexedMesh& mesh, const PatchSet& set);

/// Share of the triangles that are in triangle patches.
double triangle_share(const IndexedMesh& mesh, const PatchSet& set);

}  // namespace splice::test
