#include "preprocess/build_model/assemble_model.h"

#include "preprocess/build_model/texture_mips.h"
#include "preprocess/lod/point_octree.h"
#include "preprocess/model_format/half.h"
#include "preprocess/model_format/octahedral.h"
#include "preprocess/model_format/surfel_extent.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace splice {
namespace {

constexpr std::uint32_t kUnset = 0xffffffffu;

class Assembler {
  public:
    Assembler(const IndexedMesh& mesh, const PatchSet& patches, const RenderVertices& vertices, const PatchLods& lods,
              const SurfelSet& surfels, const PatchLayout& layout, const RegionLods& regions)
        : mesh_(mesh),
          patches_(patches),
          vertices_(vertices),
          lods_(lods),
          surfels_(surfels),
          layout_(layout),
          regions_(regions) {}

    Model assemble() {
        model_.octree = layout_.octree;
        add_triangles();
        add_patches();
        add_surfels();
        model_.point_tree = pack_point_tree(build_patch_point_octree(model_.surfels, model_.patches, model_.octree));
        add_merge_tree();
        add_materials();
        add_info();
        return std::move(model_);
    }

  private:
    std::span<const PatchLods::Level> levels_of(std::uint32_t patch) const {
        return std::span(lods_.levels)
            .subspan(lods_.patch_begin[patch], lods_.patch_begin[patch + 1] - lods_.patch_begin[patch]);
    }
    std::span<const std::uint32_t> indices_of(const PatchLods::Level& level) const {
        return std::span(lods_.indices).subspan(level.first_index, level.index_count);
    }
    std::span<const std::uint32_t> triangles_of(std::uint32_t patch) const {
        return std::span(patches_.patch_triangles)
            .subspan(patches_.patch_begin[patch], patches_.patch_begin[patch + 1] - patches_.patch_begin[patch]);
    }
    std::span<const SurfelSample> surfels_of(std::uint32_t patch) const {
        return std::span(surfels_.surfels)
            .subspan(surfels_.patch_begin[patch], surfels_.patch_begin[patch + 1] - surfels_.patch_begin[patch]);
    }

    void add_triangles();
    void add_patches();
    void add_surfels();
    void add_merge_tree();
    void add_materials();
    void add_info();

    const IndexedMesh& mesh_;
    const PatchSet& patches_;
    const RenderVertices& vertices_;
    const PatchLods& lods_;
    const SurfelSet& surfels_;
    const PatchLayout& layout_;
    const RegionLods& regions_;

    std::vector<std::uint32_t> leaf_of_triangle_;  // IndexedMesh triangle -> triangle of kIndices
    Model model_;
};

float stored_length(float length) {
    return float_from_half(half_at_least(length));
}

std::uint16_t extent_of(const SurfelSample& surfel) {
    return encode_extent({surfel.above, surfel.below, surfel.epsilon}, stored_length(surfel.radius));
}

SurfelExtent stored_extent(const SurfelSample& surfel) {
    return decode_extent(extent_of(surfel), stored_length(surfel.radius));
}

// Vertices are renumbered by first use, so that a patch's lie together.
void Assembler::add_triangles() {
    const std::size_t shared = vertices_.vertices.size();
    std::vector<std::uint32_t> new_vertex(shared + regions_.vertices.size(), kUnset);
    model_.vertices.reserve(new_vertex.size());
    model_.indices.reserve(lods_.indices.size() + regions_.indices.size());
    const auto append = [&](std::span<const std::uint32_t> indices) {
        for (const std::uint32_t old_vertex : indices) {
            if (new_vertex[old_vertex] == kUnset) {
                new_vertex[old_vertex] = static_cast<std::uint32_t>(model_.vertices.size());
                model_.vertices.push_back(old_vertex < shared ? vertices_.vertices[old_vertex]
                                                              : regions_.vertices[old_vertex - shared]);
            }
            model_.indices.push_back(new_vertex[old_vertex]);
        }
    };
    model_.lods.resize(lods_.levels.size());
    std::vector<std::uint32_t> first_lod;
    std::uint32_t lod = 0;
    leaf_of_triangle_.resize(mesh_.triangles.size());
    std::uint32_t leaf = 0;
    for (const std::uint32_t patch : layout_.order) {
        const auto levels = levels_of(patch);
        first_lod.push_back(lod);
        model_.lods[lod] = {model_.indices.size(), levels[0].index_count, 0.0f};
        lod += static_cast<std::uint32_t>(levels.size());
        append(indices_of(levels[0]));
        for (const std::uint32_t triangle : triangles_of(patch))
            leaf_of_triangle_[triangle] = leaf++;
    }
    for (std::size_t place = 0; place < layout_.order.size(); ++place) {
        const auto levels = levels_of(layout_.order[place]);
        for (std::size_t level = 1; level < levels.size(); ++level) {
            model_.lods[first_lod[place] + level] = {model_.indices.size(), levels[level].index_count,
                                                     levels[level].error};
            append(indices_of(levels[level]));
        }
    }
    for (std::size_t node = 0; node + 1 < regions_.level_begin.size(); ++node) {
        const std::uint32_t first = regions_.level_begin[node], end = regions_.level_begin[node + 1];
        if (first == end) continue;
        model_.octree[node].first_lod = static_cast<std::uint32_t>(model_.lods.size());
        model_.octree[node].lod_count = end - first;
        for (const PatchLods::Level& level : std::span(regions_.levels).subspan(first, end - first)) {
            model_.lods.push_back({model_.indices.size(), level.index_count, level.error});
            append(std::span(regions_.indices).subspan(level.first_index, level.index_count));
        }
    }
}

void Assembler::add_patches() {
    std::uint64_t first_surfel = 0;
    std::uint32_t first_lod = 0;
    for (const std::uint32_t old : layout_.order) {
        const ClusterPatch& cluster = patches_.patches[old];
        const PatchExtent& extent = layout_.extents[old];
        format::Patch patch{};
        for (int axis = 0; axis < 3; ++axis) {
            patch.bounds_min[axis] = extent.bounds.min[axis];
            patch.bounds_max[axis] = extent.bounds.max[axis];
            patch.cone_axis[axis] = extent.cone.axis[axis];
        }
        patch.cone_cos = extent.cone.cosine;
        patch.representation = cluster.representation;
        patch.material = cluster.material;
        patch.first_surfel = first_surfel;
        patch.surfel_count = static_cast<std::uint32_t>(surfels_of(old).size());
        patch.first_lod = first_lod;
        patch.lod_count = static_cast<std::uint32_t>(levels_of(old).size());
        patch.area = cluster.area;
        for (const SurfelSample& surfel : surfels_of(old)) {
            patch.max_surfel_radius = std::max(patch.max_surfel_radius, stored_length(surfel.radius));
            patch.max_surfel_epsilon = std::max(patch.max_surfel_epsilon, stored_extent(surfel).epsilon);
        }
        patch.roughness = cluster.roughness;
        const bool is_leaf = cluster.merge_root < leaf_of_triangle_.size();
        patch.merge_root = is_leaf ? leaf_of_triangle_[cluster.merge_root] : cluster.merge_root;
        model_.patches.push_back(patch);
        first_surfel += patch.surfel_count;
        first_lod += patch.lod_count;
    }
}

void Assembler::add_surfels() {
    model_.surfels.reserve(surfels_.surfels.size());
    for (std::uint32_t place = 0; place < layout_.order.size(); ++place) {
        for (const SurfelSample& sample : surfels_of(layout_.order[place])) {
            const Vec3f& position = sample.position;
            const auto& bend = sample.shading_bend;
            model_.surfels.push_back(
                {{position.x(), position.y(), position.z()},
                 half_at_least(sample.radius),
                 extent_of(sample),
                 encode_octahedral(sample.normal.x(), sample.normal.y(), sample.normal.z()),
                 {static_cast<std::uint8_t>(sample.colour), static_cast<std::uint8_t>(sample.colour >> 8),
                  static_cast<std::uint8_t>(sample.colour >> 16)},
                 {bend[0], bend[1], bend[2], bend[3], bend[4]},
                 static_cast<std::uint16_t>(place),
                 sample.clip});
        }
    }
}

void Assembler::add_merge_tree() {
    model_.merge_tree = patches_.merge_tree;
    for (format::MergeNode& node : model_.merge_tree)
        for (std::uint32_t& child : node.child)
            if (child < leaf_of_triangle_.size()) child = leaf_of_triangle_[child];
}

// Images that no material uses are left out.
void Assembler::add_materials() {
    std::vector<std::uint32_t> texture_of_image(mesh_.images.size(), kUnset);
    for (const MeshMaterial& material : mesh_.materials) {
        format::Material stored{material.diffuse, format::kNoTexture};
        if (material.image != kNoImage) {
            std::uint32_t& texture = texture_of_image[material.image];
            if (texture == kUnset) {
                texture = static_cast<std::uint32_t>(model_.textures.size());
                const Image& image = mesh_.images[material.image];
                const std::vector<std::byte> chain = build_mip_chain(image);
                const auto levels = static_cast<std::uint32_t>(std::bit_width(std::max(image.width, image.height)));
                model_.textures.push_back({image.width, image.height, levels, 0, model_.texels.size(), chain.size()});
                model_.texels.insert(model_.texels.end(), chain.begin(), chain.end());
            }
            stored.texture = texture;
        }
        model_.materials.push_back(stored);
    }
}

void Assembler::add_info() {
    format::ModelInfo& info = model_.info;
    info.source_scale = mesh_.source_scale;
    for (int axis = 0; axis < 3; ++axis) {
        info.source_offset[axis] = mesh_.source_offset[axis];
        info.bounds_min[axis] = model_.octree.front().bounds_min[axis];
        info.bounds_max[axis] = model_.octree.front().bounds_max[axis];
    }
    if (!mesh_.closed || !mesh_.consistently_oriented) info.flags |= format::kTwoSided;
    if (mesh_.has_colours) info.flags |= format::kHasColours;
    if (!mesh_.corner_uvs.empty()) info.flags |= format::kHasUvs;
    info.source_vertices = mesh_.positions.size();
    info.source_triangles = mesh_.triangles.size();
    for (const format::Patch& patch : model_.patches) {
        info.lod_levels = std::max(info.lod_levels, patch.lod_count);
        info.max_surfel_radius = std::max(info.max_surfel_radius, patch.max_surfel_radius);
        if (patch.representation == format::Representation::kTriangles)
            info.drawn_triangles += model_.lods[patch.first_lod].index_count / 3;
    }
    if (model_.surfels.empty()) return;
    std::vector<float> radii;
    radii.reserve(model_.surfels.size());
    for (const format::Surfel& surfel : model_.surfels)
        radii.push_back(float_from_half(surfel.radius));
    const auto middle = radii.begin() + static_cast<std::ptrdiff_t>(radii.size() / 2);
    std::nth_element(radii.begin(), middle, radii.end());
    info.median_surfel_radius = *middle;
}

}  // namespace

Model assemble_model(const IndexedMesh& mesh, const PatchSet& patches, const RenderVertices& vertices,
                     const PatchLods& lods, const SurfelSet& surfels, const PatchLayout& layout,
                     const RegionLods& regions) {
    return Assembler(mesh, patches, vertices, lods, surfels, layout, regions).assemble();
}

}  // namespace splice
