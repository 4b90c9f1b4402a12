// Which parts of a surface are drawn as triangles and which as surfels, by geometry alone.
//
// In plain words: a place is rough when the normals within 0.02 of the model's size spread by more than 4.3 degrees.
// Two things make a place count as less rough than that. First, its triangles are large: if a ball of that radius holds
// fewer than 12 of them, the spread is the faceting of a coarse mesh and not detail, and so large a triangle costs less
// than the surfels that would replace it. Second, it is a flat face that merely ends near a crease or belongs to a thin
// plate: what faces the same way as the place itself spreads by less than a third of the threshold.
//
//   score = min(ball * min(1, n / 12), 3 * sheet)        triangles where score <= 0.075 rad (4.3 degrees)
//
// with ball and sheet as in roughness.h and n = pi 0.02^2 / (area of the triangle). A plain sphere of any fine
// tessellation scores 1.6 degrees, an edge of a machined part 0, a scan's fur or scales 8 to 30.
#pragma once

#include "preprocess/cluster/roughness.h"

#include <cstdint>
#include <vector>

namespace splice {

inline constexpr float kRoughScore = 0.075f;   // radians; above: surfels
inline constexpr float kFewTriangles = 12.0f;  // in a ball of kRoughnessRadius
inline constexpr float kSheetFactor = 3.0f;

/// The score of each face, radians, in slot order.
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
