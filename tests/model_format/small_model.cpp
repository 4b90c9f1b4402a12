#include "tests/model_format/small_model.h"

#include "preprocess/model_format/half.h"
#include "preprocess/model_format/octahedral.h"
#include "preprocess/model_format/surfel_extent.h"

namespace splice::test {
namespace {

using namespace format;

const std::uint32_t kUp = encode_octahedral(0, 0, 1);

Patch patch_over(float x_min, float x_max) {
    Patch patch{};
    patch.bounds_min[0] = x_min;
    patch.bounds_max[0] = x_max;
    patch.bounds_max[1] = 1;
    patch.cone_axis[2] = 1;
    patch.cone_cos = 0.5f;
    patch.area = 0.5f;
    return patch;
}

OctreeNode node_over(float x_min, float x_max, std::uint32_t first_patch, std::uint32_t patch_count) {
    OctreeNode node{};
    node.bounds_min[0] = x_min;
    node.bounds_max[0] = x_max;
    node.bounds_max[1] = 1;
    node.first_patch = first_patch;
    node.patch_count = patch_count;
    return node;
}

}  // namespace

Model small_model() {
    Model model;
    // A strip of six triangles over [0, 1] x [0, 1]; patch 0 has the first four, patch 1 the other two.
    for (const float x : {0.0f, 0.25f, 0.5f, 1.0f})
        for (const float y : {0.0f, 1.0f})
            model.vertices.push_back({{x, y, 0}, kUp, 0xff8040ffu, {x, y}});
    model.indices = {0, 2, 1, 1, 2, 3, 2, 4, 3, 3, 4, 5, 4, 6, 5, 5, 6, 7, /* coarser: */ 0, 4, 1, 1, 4, 5};
    model.lods = {{0, 12, 0}, {18, 6, 0.125f}, {12, 6, 0}};
    model.surfels = {{{0.6f, 0.5f, 0},
                      half_at_least(0.25f),
                      encode_extent({0, 0, 0.29f}, 0.25f),
                      kUp,
                      {255, 255, 255},
                      {0, 0, 0, 0, 0},
                      1,
                      0},
                     {{0.9f, 0.5f, 0},
                      half_at_least(0.2f),
                      encode_extent({0.01f, 0.001f, 0.25f}, 0.2f),
                      kUp,
                      {0, 255, 0},
                      {127, -5, 3, 0, 1},
                      1,
                      0}};

    Patch triangles = patch_over(0, 0.5f);
    triangles.lod_count = 2;
    triangles.merge_root = 8;
    Patch surfels = patch_over(0.5f, 1);
    surfels.representation = Representation::kSurfels;
    surfels.material = 1;
    surfels.surfel_count = 2;
    surfels.first_lod = 2;
    surfels.lod_count = 1;
    surfels.max_surfel_radius = 0.25f;
    surfels.max_surfel_epsilon = 0.3f;
    surfels.roughness = 0.1f;
    surfels.merge_root = 9;
    model.patches = {triangles, surfels};

    OctreeNode root = node_over(0, 1, 0, 2);
    root.first_child = 1;
    root.child_count = 2;
    model.octree = {root, node_over(0, 0.5f, 0, 1), node_over(0.5f, 1, 1, 1)};
    model.merge_tree = {{{0, 1}, 0.1f, 1}, {{2, 3}, 0.2f, 1}, {{6, 7}, 0.3f, 1}, {{4, 5}, 0.4f, 2}};
    model.materials = {{0xffffffffu, kNoTexture}, {0xff0000ffu, 0}};
    model.textures = {{3, 2, 2, 0, 0, (6 + 1) * 4}};
    for (int i = 0; i < 28; ++i)
        model.texels.push_back(static_cast<std::byte>(i * 9));

    ModelInfo& info = model.info;
    info.source_scale = 2.5;
    info.source_offset[0] = -1;
    info.bounds_max[0] = 1;
    info.bounds_max[1] = 1;
    info.flags = kTwoSided | kHasUvs;
    info.lod_levels = 2;
    info.source_vertices = 8;
    info.source_triangles = 6;
    info.drawn_triangles = 4;
    info.max_surfel_radius = 0.25f;
    info.median_surfel_radius = 0.2f;
    return model;
}

}  // namespace splice::test
