// Which parts of a surface are drawn as triangles and which as surfels, by geometry alone.
//
// In plain words: a place is rough when the normals within 0.02 of the model's size spread by more than 4.3 degrees.
// What makes a place count as less rough than that:
// - Large triangles. If a disk of that radius holds fewer than 9 of them, the spread is the faceting of a coarse mesh
// and
//   not detail, and so large a triangle costs less than the surfels that would replace it.
// - A face of a machined part that ends near a crease, or a thin plate. What faces the way the triangle does, to 30
//   degrees, is looked at alone; if it spreads by at most half the threshold and a neighbour continues the triangle (to
//   1 degree), the crease is not counted.
// - A plane, however narrow: four or more triangles of a quarter of that disk's area or more that continue each other
// to
//   0.25 degrees and in all spread by at most half the threshold.
//
//   score = ball * min(1, triangles / 9)        (ball, triangles: roughness.h)
//           at most 2 * sheet                   where there is a neighbour to 1 degree and 2 * sheet <= threshold
//           0                                   in a plane
//   triangles where score <= threshold = 0.075 rad (4.3 degrees), surfels elsewhere
//
// The criterion is absolute: a cube or any flat face scores 0, a finely tessellated plain sphere 1.6 degrees, a sphere
// of 320 triangles 0.3; the bumps of a scan 5 to 50. So a smooth model may keep all its triangles, a noisy one none.
#pragma once

#include "preprocess/cluster/roughness.h"

#include <cstdint>
#include <vector>

namespace splice {

inline constexpr float kRoughScore = 0.075f;  // radians; above: surfels

/// The score of each face, radians, in slot order. `faces` with its links.
std::vector<float> score_faces(const FaceGraph& faces, const FaceRoughness& roughness);

/// The score that a share of the faces stays at or below; share in 0..1.
float score_at_share(const std::vector<float>& scores, double share);

/// A candidate for being drawn as triangles.
struct ScoredPatch {
    float score;         // lower is flatter
    std::uint32_t slot;  // breaks ties
    std::uint32_t faces;
};

/// The flattest patches whose faces add up to `target`, or as near below it as they come: in order of score, leaving
/// out what does not fit any more. Returns slots.
std::vector<std::uint32_t> choose_flattest(std::vector<ScoredPatch> patches, std::uint64_t target);

}  // namespace splice
