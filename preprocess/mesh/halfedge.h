// Which faces share an edge, found on an OpenMesh half-edge structure. This is the only part of the tree that knows
// OpenMesh.
#pragma once

#include "preprocess/mesh/indexed_mesh.h"

#include <cstdint>
#include <span>
#include <vector>

namespace splice {

/// Two faces that share an edge. Ids are those of the IndexedMesh; face[0] < face[1].
struct FacePair {
    std::uint32_t face[2];
    std::uint32_t vertex[2];
};

struct FaceAdjacency {
    std::vector<FacePair> pairs;   // one for each edge with exactly two faces, whatever their orientation
    std::uint64_t torn_edges = 0;  // with more than two faces, or two that run the same way along it
};

/// An edge used by three or more faces pairs nothing: it is a border for whoever walks the pairs. What no half-edge
/// structure can hold (non-manifold edges, Moebius seams, several fans at a vertex) it gets with duplicated vertices
/// and edges; edges that are torn apart so are joined again if they have exactly two faces. `mesh` needs the invariants
/// of IndexedMesh. O(faces).
///
/// Faces are inserted in `order`, a permutation of them; an order that keeps neighbours together is faster.
FaceAdjacency find_face_adjacency(const IndexedMesh& mesh, std::span<const std::uint32_t> order);

}  // namespace splice
