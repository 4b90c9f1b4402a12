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
    std::vector<FacePair> pairs;       // one for each edge with exactly two faces, whatever their orientation
    std::uint64_t detached_faces = 0;  // faces that the half-edge structure could only take with vertices of their own
};

/// An edge used by three or more faces pairs nothing: it is a border for whoever walks the pairs. Faces that no
/// half-edge structure can hold (non-manifold edges, Moebius seams, several fans at a vertex) are inserted with
/// duplicated vertices; edges which that tears apart are joined again if they have exactly two faces. `mesh` needs the
/// invariants of IndexedMesh. O(faces), about 3 M faces a second.
///
/// Faces are inserted in `order`, a permutation of them; an order that keeps neighbours together is up to twice as
/// fast.
FaceAdjacency find_face_adjacency(const IndexedMesh& mesh, std::span<const std::uint32_t> order);

}  // namespace splice
