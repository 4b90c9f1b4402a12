// Does the choice of surfels agree with the surface? Measured apart from the criterion that made it.
#pragma once

#include "preprocess/cluster/face_graph.h"
#include "preprocess/cluster/patch_set.h"

namespace splice {

/// The probability that a random point of a surfel patch is rougher than a random point of a triangle patch (area
/// uniform, ties count half): 1 a perfect choice, 0.5 a choice by lot. Roughness at a point is the RMS angle between
/// the face normals at all points within 0.02 of the model's size and their mean. Up to 80,000 points are spread evenly
/// over the area, the same ones in every run, so that about 40 lie on a disk of that radius; each fourth is compared.
/// 0.5 if one kind is missing.
double measure_selection_auc(const IndexedMesh& mesh, const FaceGraph& faces, const PatchSet& patches);

}  // namespace splice
