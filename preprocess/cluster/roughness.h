// How much the surface varies around each place, at one fixed scale of the model.
#pragma once

#include "preprocess/cluster/face_graph.h"

#include <cstdint>
#include <vector>

namespace splice {

/// Radius of the ball in which normals are compared, unit-box units.
inline constexpr float kRoughnessRadius = 0.02f;

/// One value a slot; large faces take the mean over their area. A spread is in radians, 0 to sqrt 2: of unit normals
/// sqrt(2 (1 - |their area-weighted mean|)), which for small spreads is their RMS angle to the mean.
struct FaceRoughness {
    std::vector<float> ball;   // spread over all surface in the ball, other sheets and far sides of creases included
    std::vector<float> sheet;  // spread over the part of it that faces within 30 degrees of the face
    std::vector<float>
        triangles;  // how many of the ball's triangles fit on a disk of its radius: low for coarse meshes
};

/// The surface is summed into grid cells of half the radius, apart for different directions, and cells are
/// compared with cells. O(faces + area / radius^2); deterministic for any number of threads.
FaceRoughness measure_roughness(const IndexedMesh& mesh, const FaceGraph& faces);

}  // namespace splice
