// How much the surface varies around each face, at one fixed scale of the model.
#pragma once

#include "preprocess/cluster/face_graph.h"

#include <vector>

namespace splice {

/// Radius of the ball in which normals are compared, unit-box units.
inline constexpr float kRoughnessRadius = 0.02f;

struct FaceRoughness {
    // Both in radians, 0 to sqrt 2: the spread of a set of normals is sqrt(2 (1 - |mean of unit normals|)), which for
    // small spreads is their RMS angle to the mean. Area weighted, one a slot; large faces take the mean over their
    // area.
    std::vector<float> ball;   // over all surface in the ball, other sheets and the far side of creases included
    std::vector<float> sheet;  // only over surface in the ball that faces within 30 degrees of the face
};

/// The surface is summed into grid cells of a third of the radius (apart for different directions), and cells are
/// compared with cells. O(faces + area / radius^2); deterministic for any number of threads.
FaceRoughness measure_roughness(const IndexedMesh& mesh, const FaceGraph& faces);

}  // namespace splice
