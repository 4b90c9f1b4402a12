// Does the choice of surfels agree with the surface? Measured apart from the criterion that made it.
#pragma once

#include "preprocess/cluster/face_graph.h"
#include "preprocess/cluster/patch_set.h"

#include <cstdint>
#include <optional>
#include <vector>

namespace splice {

/// A place on the surface by which a choice is judged.
struct JudgedPlace {
    float roughness;  // RMS angle between the face normals at all points within 0.02 of the model's size and their mean
    std::uint32_t face;  // IndexedMesh triangle
};

/// Places in ascending order of roughness. Up to 80,000 points are spread evenly over the area, the same ones in every
/// run, so that about 40 lie on a disk of that radius; each fourth is a place. Knows nothing of the choice.
std::vector<JudgedPlace> judge_places(const IndexedMesh& mesh, const FaceGraph& faces);

/// The probability that a random point of a surfel patch is rougher than a random point of a triangle patch (area
/// uniform, ties count half): 1 a perfect choice, 0.5 a choice by lot. Nothing where one kind is missing.
std::optional<double> selection_auc(const std::vector<JudgedPlace>& places, const PatchSet& patches);

}  // namespace splice
