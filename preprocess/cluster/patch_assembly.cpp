#include "preprocess/cluster/patch_assembly.h"

#include <algorithm>
#include <cmath>

namespace splice {

namespace {

/// The cluster that each slot ended in, named by that cluster's slot.
std::vector<std::uint32_t> cluster_of_slots(const ClusterGraph& graph) {
    // A merged slot's cluster has a lower slot, so one pass upwards resolves every chain.
    std::vector<std::uint32_t> cluster(graph.slots());
    for (std::uint32_t s = 0; s < graph.slots(); ++s)
        cluster[s] = graph.alive(s) ? s : cluster[graph.merged_into(s)];
    return cluster;
}

}  // namespace

PatchSet assemble_patches(const IndexedMesh& mesh, const FaceGraph& faces, ClusterGraph& graph,
                          const std::vector<std::uint32_t>& slot_of_face,
                          const std::vector<std::uint8_t>& surfel_slot) {
    const std::vector<std::uint32_t> cluster_of_slot = cluster_of_slots(graph);
    PatchSet set;
    std::vector<std::uint32_t> patch_of_slot(graph.slots());
    for (std::uint32_t s = 0; s < graph.slots(); ++s) {
        if (!graph.alive(s)) continue;
        patch_of_slot[s] = static_cast<std::uint32_t>(set.patches.size());
        ClusterPatch patch;
        patch.representation = surfel_slot[s] ? format::Representation::kSurfels : format::Representation::kTriangles;
        patch.merge_root = graph.node(s);
        set.patches.push_back(patch);
    }

    set.triangle_patch.resize(faces.size());
    set.patch_begin.assign(set.patches.size() + 1, 0);
    std::vector<Vec3d> normal_sum(set.patches.size(), Vec3d::Zero());
    std::vector<double> area(set.patches.size(), 0), turn(set.patches.size(), 0);
    for (std::size_t s = 0; s < faces.size(); ++s) {
        const std::uint32_t p = patch_of_slot[cluster_of_slot[slot_of_face[s]]], face = faces.face_of_slot[s];
        set.triangle_patch[face] = p;
        if (!mesh.triangle_material.empty())
            set.patches[p].material = mesh.triangle_material[face];  // the same for all
        ++set.patch_begin[p + 1];
        area[p] += static_cast<double>(faces.area[s]);
        normal_sum[p] += static_cast<double>(faces.area[s]) * faces.normal[s].cast<double>();
    }
    for (std::size_t p = 0; p < set.patches.size(); ++p) {
        set.patch_begin[p + 1] += set.patch_begin[p];
        set.patches[p].area = static_cast<float>(area[p]);
        // A closed patch's normals may cancel: keep the default direction then.
        if (normal_sum[p].norm() > 1e-6 * area[p])
            set.patches[p].mean_normal = normal_sum[p].normalized().cast<float>();
    }
    for (std::size_t s = 0; s < faces.size(); ++s) {
        const std::uint32_t p = patch_of_slot[cluster_of_slot[slot_of_face[s]]];
        const float angle = angle_between(faces.normal[s], set.patches[p].mean_normal);
        turn[p] += static_cast<double>(faces.area[s] * angle * angle);
    }
    for (std::size_t p = 0; p < set.patches.size(); ++p) {
        set.patches[p].roughness = static_cast<float>(std::sqrt(turn[p] / area[p]));
    }

    set.patch_triangles.resize(faces.size());
    std::vector<std::uint32_t> next(set.patch_begin.begin(), set.patch_begin.end() - 1);
    for (std::uint32_t f = 0; f < faces.size(); ++f)
        set.patch_triangles[next[set.triangle_patch[f]]++] = f;

    set.merge_tree = graph.take_tree();
    for (std::size_t p = 0; p < set.patches.size(); ++p) {
        if (set.patches[p].representation == format::Representation::kSurfels) {
            ++set.stats.surfel_patches;
        } else {
            ++set.stats.triangle_patches;
            set.stats.triangles_in_triangle_patches += set.patch_begin[p + 1] - set.patch_begin[p];
        }
    }
    return set;
}

}  // namespace splice
