// The result of clustering: every triangle in exactly one connected patch, the patches' representations, and the tree
// of merges that made them.
#pragma once

#include "preprocess/mesh/indexed_mesh.h"
#include "preprocess/model_format/model_format.h"

#include <cstdint>
#include <optional>
#include <vector>

namespace splice {

struct ClusterPatch {
    format::Representation representation = format::Representation::kTriangles;
    std::uint32_t material = 0;
    float area = 0;                      // unit-box units^2
    Vec3f mean_normal = Vec3f::UnitZ();  // area weighted, unit
    float roughness = 0;                 // area-weighted RMS angle of face normals to mean_normal, radians
    std::uint32_t merge_root = 0;  // node id in merge_tree, see format::MergeNode; leaf ids are IndexedMesh triangles
};

struct ClusterStats {
    std::uint64_t triangle_patches = 0, surfel_patches = 0;
    std::uint64_t triangles_in_triangle_patches = 0;
    // P(point of a surfel patch is rougher than one of a triangle patch), see selection_auc.h; none when one kind is
    // missing.
    std::optional<double> selection_auc;
    double seconds_judge = 0;  // what measuring selection_auc took
};

struct PatchSet {
    std::vector<ClusterPatch> patches;
    std::vector<std::uint32_t> patch_begin;      // size patches + 1, into patch_triangles
    std::vector<std::uint32_t> patch_triangles;  // triangles grouped by patch, ascending inside a patch
    std::vector<std::uint32_t> triangle_patch;   // one a triangle
    std::vector<format::MergeNode> merge_tree;   // leaf ids are IndexedMesh triangles here; build_model renumbers
    ClusterStats stats;
};

}  // namespace splice
