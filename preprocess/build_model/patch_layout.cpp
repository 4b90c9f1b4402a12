#include "preprocess/build_model/patch_layout.h"

#include "preprocess/model_format/half.h"
#include "preprocess/model_format/octahedral.h"

#include <tbb/parallel_for.h>

#include <Eigen/Geometry>
#include <span>
#include <utility>

namespace splice {
namespace {

Vec3f position_of(const format::Vertex& vertex) {
    return {vertex.position[0], vertex.position[1], vertex.position[2]};
}

Vec3f decoded_normal(std::uint32_t bits) {
    const auto normal = decode_octahedral(bits);
    return {normal[0], normal[1], normal[2]};
}

// The extent of a disk along an axis is r sqrt(1 - n^2); widened by its rounding.
void add_disk(Box& box, const SurfelSample& surfel) {
    const Vec3f squares = surfel.normal.cwiseProduct(surfel.normal);
    const float radius = float_from_half(half_at_least(surfel.radius));
    const Vec3f reach = (Vec3f::Ones() - squares).cwiseMax(0.0f).cwiseSqrt() * radius + Vec3f::Constant(1e-6f);
    box.add(surfel.position - reach);
    box.add(surfel.position + reach);
}

// The cone must hold what decides whether something is seen from behind: the shading normals, and the geometric normals
// of every level, by which triangles are culled.
PatchExtent measure_patch(const RenderVertices& vertices, const PatchLods& lods, const SurfelSet& surfels,
                          std::size_t patch) {
    PatchExtent extent;
    std::vector<Vec3f> normals;
    for (std::uint32_t i = lods.patch_begin[patch]; i < lods.patch_begin[patch + 1]; ++i) {
        const auto indices = std::span(lods.indices).subspan(lods.levels[i].first_index, lods.levels[i].index_count);
        for (std::size_t triangle = 0; triangle < indices.size(); triangle += 3) {
            const format::Vertex* corners[3];
            for (std::size_t k = 0; k < 3; ++k) {
                corners[k] = &vertices.vertices[indices[triangle + k]];
                extent.bounds.add(position_of(*corners[k]));
                normals.push_back(decoded_normal(corners[k]->normal));
            }
            const Vec3d edge_a = (position_of(*corners[1]) - position_of(*corners[0])).cast<double>();
            const Vec3d edge_b = (position_of(*corners[2]) - position_of(*corners[0])).cast<double>();
            const Vec3d face_normal = edge_a.cross(edge_b);
            if (face_normal.squaredNorm() > 0) normals.push_back(face_normal.normalized().cast<float>());
        }
    }
    for (std::uint64_t i = surfels.patch_begin[patch]; i < surfels.patch_begin[patch + 1]; ++i) {
        const SurfelSample& surfel = surfels.surfels[i];
        add_disk(extent.bounds, surfel);
        normals.push_back(decoded_normal(encode_octahedral(surfel.normal.x(), surfel.normal.y(), surfel.normal.z())));
    }
    extent.cone = enclose_normals(normals);
    return extent;
}

}  // namespace

PatchLayout lay_out_patches(const RenderVertices& vertices, const PatchLods& lods, const SurfelSet& surfels) {
    PatchLayout layout;
    layout.extents.resize(lods.patch_begin.size() - 1);
    tbb::parallel_for(std::size_t{0}, layout.extents.size(), [&](std::size_t patch) {
        layout.extents[patch] = measure_patch(vertices, lods, surfels, patch);
    });
    std::vector<Box> bounds;
    bounds.reserve(layout.extents.size());
    for (const PatchExtent& extent : layout.extents)
        bounds.push_back(extent.bounds);
    PatchOctree octree = build_patch_octree(bounds);
    layout.order = std::move(octree.order);
    layout.octree = std::move(octree.nodes);
    return layout;
}

}  // namespace splice
