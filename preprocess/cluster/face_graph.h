// The dual graph that clustering contracts: a node a face, a link between faces that share an edge of the mesh. Faces
// are renumbered along a space-filling curve, because clustering 871 k faces in file order is bound by cache misses.
#pragma once

#include "preprocess/mesh/halfedge.h"
#include "preprocess/mesh/indexed_mesh.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

namespace splice {

/// What clustering needs of each face, in slot order. Lengths in unit-box units.
struct FaceGraph {
    struct Link {
        std::uint32_t slot[2];  // ascending
        float length;           // of the shared edge
    };

    std::vector<std::uint32_t> face_of_slot;  // slot -> IndexedMesh triangle
    std::vector<float> area;
    std::vector<float> perimeter;
    std::vector<Vec3f> normal;  // unit
    std::vector<Link> links;    // never across different materials; ascending by slot[0], slot[1]

    std::size_t size() const { return face_of_slot.size(); }
    /// The corners' positions of the face in `slot`.
    std::array<Vec3f, 3> corners(const IndexedMesh& mesh, std::size_t slot) const {
        const Triangle& t = mesh.triangles[face_of_slot[slot]];
        return {mesh.positions[t[0]], mesh.positions[t[1]], mesh.positions[t[2]]};
    }
};

/// Radians between unit vectors, by the chord: exact for small angles, where the arc cosine is not.
inline float angle_between(const Vec3f& a, const Vec3f& b) {
    return 2 * std::asin(std::min(1.0f, (a - b).norm() / 2));
}

/// x without its whole part; x >= 0 and below 2^63. (The library's fmod is far slower.)
inline double fraction(double x) {
    return x - static_cast<double>(static_cast<std::int64_t>(x));
}

/// Faces by the Morton code of their centroid, ties by index: what goes into each slot.
std::vector<std::uint32_t> order_faces(const IndexedMesh& mesh);

/// All but the links, of the faces in `order`. Deterministic for any number of threads.
FaceGraph measure_faces(const IndexedMesh& mesh, std::vector<std::uint32_t> order);

/// The links, from the half-edge structure's pairs of faces.
std::vector<FaceGraph::Link> link_faces(const IndexedMesh& mesh, std::span<const std::uint32_t> face_of_slot,
                                        const FaceAdjacency& adjacency);

}  // namespace splice
