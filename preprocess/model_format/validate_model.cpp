#include "preprocess/model_format/validate_model.h"

#include "preprocess/model_format/error.h"
#include "preprocess/model_format/half.h"
#include "preprocess/model_format/packed_surfel.h"
#include "preprocess/model_format/point_node.h"
#include "preprocess/model_format/surfel_extent.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <functional>
#include <sstream>
#include <vector>

namespace splice {
namespace {

using namespace format;

bool all_finite(const float (&values)[3]) {
    return std::isfinite(values[0]) && std::isfinite(values[1]) && std::isfinite(values[2]);
}

bool is_length(float value) {
    return value >= 0 && std::isfinite(value);
}

template <typename Box>
bool is_box(const Box& box) {
    for (int axis = 0; axis < 3; ++axis)
        if (!(box.bounds_min[axis] <= box.bounds_max[axis])) return false;
    return all_finite(box.bounds_min) && all_finite(box.bounds_max);
}

template <typename Outer, typename Inner>
bool contains(const Outer& outer, const Inner& inner) {
    for (int axis = 0; axis < 3; ++axis)
        if (outer.bounds_min[axis] > inner.bounds_min[axis] || outer.bounds_max[axis] < inner.bounds_max[axis])
            return false;
    return true;
}

class Validator {
  public:
    Validator(const ModelView& view, const std::byte* base, const std::string& name)
        : view_(view), base_(base), name_(name) {}

    void run() const {
        check_info();
        check_vertices();
        check_indices();
        check_textures();
        check_patches();
        if (is_cloud()) {
            check_packed_surfels();
        } else {
            check_surfels();
        }
        check_octree();
        check_merge_tree();
        check_point_tree();
    }

  private:
    template <typename... Parts>
    [[noreturn]] void fail(const void* where, const Parts&... parts) const {
        std::ostringstream problem;
        (problem << ... << parts);
        throw InputError(name_, "byte " + std::to_string(static_cast<const std::byte*>(where) - base_), problem.str());
    }

    template <typename T, typename... Parts>
    void require(bool holds, const T& where, const Parts&... parts) const {
        if (!holds) [[unlikely]]
            fail(&where, parts...);
    }

    bool is_cloud() const { return (view_.info->flags & kPointCloud) != 0; }

    void check_info() const {
        const ModelInfo& info = *view_.info;
        require(std::isfinite(info.source_scale) && info.source_scale > 0, info.source_scale,
                "source scale is not positive");
        for (const double offset : info.source_offset)
            require(std::isfinite(offset), info.source_offset, "source offset is not finite");
        require(is_box(info), info.bounds_min, "model info: bounds are not a box");
        require((info.flags & ~(kTwoSided | kHasColours | kHasUvs | kPointCloud)) == 0, info.flags, "unknown flags ",
                info.flags);
        require(is_length(info.max_surfel_radius), info.max_surfel_radius, "largest surfel radius is not a length");
        require(is_length(info.median_surfel_radius) && info.median_surfel_radius <= info.max_surfel_radius,
                info.median_surfel_radius, "median surfel radius is not between 0 and the largest");
        const std::uint64_t nodes = info.source_triangles + view_.merge_tree.size();
        require(info.source_triangles <= UINT32_MAX && nodes <= UINT32_MAX, info.source_triangles,
                "more triangles and merges than 32-bit ids");
        require(!is_cloud() || nodes == 0, info.source_triangles, "a point cloud with triangles or merges");
    }

    void check_vertices() const {
        for (const Vertex& vertex : view_.vertices) {
            require(all_finite(vertex.position), vertex, "vertex position is not finite");
            require(std::isfinite(vertex.uv[0]) && std::isfinite(vertex.uv[1]), vertex.uv, "vertex uv is not finite");
        }
    }

    void check_indices() const {
        const std::uint64_t vertices = view_.vertices.size();
        for (const std::uint32_t& index : view_.indices)
            require(index < vertices, index, "vertex index ", index, " of ", vertices, " vertices");
    }

    void check_textures() const {
        std::uint64_t first_byte = 0;
        for (const Texture& texture : view_.textures) {
            require(texture.width > 0 && texture.height > 0, texture, "texture of ", texture.width, " x ",
                    texture.height);
            require(texture.reserved == 0, texture.reserved, "reserved bytes are not 0");
            const std::uint32_t levels =
                static_cast<std::uint32_t>(std::bit_width(std::max(texture.width, texture.height)));
            require(texture.mip_levels == levels, texture.mip_levels, texture.mip_levels, " mip levels, expected ",
                    levels);
            require(texture.first_byte == first_byte, texture.first_byte, "texture starts at texel byte ",
                    texture.first_byte, ", expected ", first_byte);
            const std::uint64_t available = view_.texels.size() - first_byte;
            std::uint64_t bytes = 0;
            for (std::uint32_t level = 0; level < levels; ++level) {
                const std::uint64_t texels =
                    std::uint64_t{std::max(texture.width >> level, 1u)} * std::max(texture.height >> level, 1u);
                require(texels <= (available - bytes) / 4, texture, "texture is larger than the texels that are left");
                bytes += texels * 4;
            }
            require(texture.byte_count == bytes, texture.byte_count, "texture of ", texture.byte_count,
                    " bytes, expected ", bytes);
            first_byte += bytes;
        }
        require(first_byte == view_.texels.size(), *view_.info, view_.texels.size(), " texel bytes, the textures have ",
                first_byte);
        require(!view_.materials.empty(), *view_.info, "no material, expected at least one");
        for (const Material& material : view_.materials)
            require(material.texture == kNoTexture || material.texture < view_.textures.size(), material.texture,
                    "texture index ", material.texture, " of ", view_.textures.size(), " textures");
    }

    void check_patches() const {
        require(!view_.patches.empty(), *view_.info, "no patch, expected at least one");
        std::uint64_t surfel = 0, lod = 0, index = 0, drawn = 0;
        for (const Patch& patch : view_.patches) {
            check_patch(patch);
            require(patch.first_surfel == surfel, patch.first_surfel, "patch's surfels start at ", patch.first_surfel,
                    ", expected ", surfel);
            require(patch.surfel_count <= view_.surfel_count() - surfel, patch.surfel_count, patch.surfel_count,
                    " surfels in a patch, ", view_.surfel_count() - surfel, " are left");
            require(patch.first_lod == lod, patch.first_lod, "patch's levels start at ", patch.first_lod, ", expected ",
                    lod);
            require(patch.lod_count >= 1 && patch.lod_count <= view_.lods.size() - lod, patch.lod_count,
                    patch.lod_count, " levels in a patch, ", view_.lods.size() - lod, " are left, at least 1 expected");
            require(patch.lod_count <= view_.info->lod_levels, patch.lod_count, patch.lod_count,
                    " levels in a patch, at most ", view_.info->lod_levels, " expected");
            const auto lods = view_.lods.subspan(lod, patch.lod_count);
            check_lods(lods);
            require(lods.front().error == 0, lods.front().error, "finest level has an error of ", lods.front().error);
            require(lods.front().first_index == index, lods.front(), "finest level starts at index ",
                    lods.front().first_index, ", expected ", index);
            surfel += patch.surfel_count;
            lod += patch.lod_count;
            index += lods.front().index_count;
            if (patch.representation == Representation::kTriangles) drawn += lods.front().index_count / 3;
        }
        const ModelInfo& info = *view_.info;
        require(surfel == view_.surfel_count(), info, view_.surfel_count(), " surfels, the patches have ", surfel);
        std::uint64_t of_nodes = 0;  // what is made for nodes' levels is as much as they have
        for (const OctreeNode& node : view_.octree) {
            if (node.lod_count == 0) {
                require(node.first_lod == 0, node.first_lod, "octree node without levels names one");
                continue;
            }
            require(node.first_lod == lod, node.first_lod, "octree node's levels start at ", node.first_lod,
                    ", expected ", lod);
            require(node.lod_count <= view_.lods.size() - lod, node.lod_count, node.lod_count,
                    " levels in an octree node, ", view_.lods.size() - lod, " are left");
            check_lods(view_.lods.subspan(lod, node.lod_count));
            for (const Lod& level : view_.lods.subspan(lod, node.lod_count))
                of_nodes += level.index_count;
            require(of_nodes <= view_.indices.size(), node.lod_count, "octree nodes' levels have more than the ",
                    view_.indices.size(), " indices there are");
            lod += node.lod_count;
        }
        require(lod == view_.lods.size(), info, view_.lods.size(), " levels, the patches and octree nodes have ", lod);
        require(index == info.source_triangles * 3, info.source_triangles, info.source_triangles,
                " source triangles, the finest levels have ", index / 3);
        require(drawn == info.drawn_triangles, info.drawn_triangles, info.drawn_triangles,
                " drawn triangles, the triangle patches have ", drawn);
    }

    void check_patch(const Patch& patch) const {
        require(is_box(patch), patch, "patch bounds are not a box");
        require(contains(*view_.info, patch), patch, "patch bounds leave the model's");
        const bool triangles = patch.representation == Representation::kTriangles;
        require(triangles || patch.representation == Representation::kSurfels, patch.representation,
                "unknown representation ", static_cast<std::uint32_t>(patch.representation));
        require(!triangles || patch.surfel_count == 0, patch.surfel_count, "a triangle patch with surfels");
        require(patch.material < view_.materials.size(), patch.material, "material index ", patch.material, " of ",
                view_.materials.size(), " materials");
        const float(&axis)[3] = patch.cone_axis;
        const float squared = axis[0] * axis[0] + axis[1] * axis[1] + axis[2] * axis[2];
        require(std::abs(squared - 1) < 1e-3f, patch.cone_axis, "normal cone's axis is not a unit vector");
        require(patch.cone_cos >= -1 && patch.cone_cos <= 1, patch.cone_cos, "normal cone's cosine is not in -1..1");
        require(is_length(patch.area), patch.area, "patch area is not finite and positive");
        require(is_length(patch.roughness), patch.roughness, "patch roughness is not finite and positive");
        require(is_length(patch.max_surfel_radius) && patch.max_surfel_radius <= view_.info->max_surfel_radius,
                patch.max_surfel_radius, "patch's largest surfel radius exceeds the model's");
        require(is_length(patch.max_surfel_epsilon), patch.max_surfel_epsilon,
                "patch's largest epsilon is not a length");
        const std::uint64_t nodes = is_cloud() ? 1 : view_.info->source_triangles + view_.merge_tree.size();
        require(patch.merge_root < nodes, patch.merge_root, "merge root ", patch.merge_root,
                " is not in the merge tree");
        require(patch.reserved == 0, patch.reserved, "reserved bytes are not 0");
    }

    void check_lods(std::span<const Lod> lods) const {
        for (const Lod& lod : lods) {
            require(lod.index_count % 3 == 0, lod.index_count, lod.index_count, " indices are no whole triangles");
            require(
                lod.first_index <= view_.indices.size() && lod.index_count <= view_.indices.size() - lod.first_index,
                lod, "level of detail leaves the ", view_.indices.size(), " indices");
            require(is_length(lod.error), lod.error, "level's error is not a length");
        }
    }

    void check_packed_surfels() const {
        require(view_.surfels.empty(), *view_.info, "a point cloud with surfels that are not packed");
        for (const Patch& patch : view_.patches) {
            for (const PackedSurfel& packed : view_.packed_surfels.subspan(patch.first_surfel, patch.surfel_count)) {
                const Surfel surfel = unpack_surfel(packed, 0);
                const float radius = float_from_half(surfel.radius);
                require(radius <= patch.max_surfel_radius, packed,
                        "surfel radius is not between 0 and the patch's largest");
                require(decode_extent(surfel.extent, radius).epsilon <= patch.max_surfel_epsilon, packed,
                        "surfel epsilon is not between 0 and the patch's largest");
            }
        }
    }

    void check_surfels() const {
        require(view_.packed_surfels.empty(), *view_.info, "packed surfels in a model that is no point cloud");
        for (std::uint32_t p = 0; p < view_.patches.size(); ++p) {
            const Patch& patch = view_.patches[p];
            for (const Surfel& surfel : view_.surfels.subspan(patch.first_surfel, patch.surfel_count)) {
                require(all_finite(surfel.position), surfel, "surfel position is not finite");
                const float radius = float_from_half(surfel.radius),
                            epsilon = decode_extent(surfel.extent, radius).epsilon;
                require(radius >= 0 && radius <= patch.max_surfel_radius, surfel.radius,
                        "surfel radius is not between 0 and the patch's largest");
                require(epsilon >= 0 && epsilon <= patch.max_surfel_epsilon, surfel.extent,
                        "surfel epsilon is not between 0 and the patch's largest");
                require(surfel.patch == static_cast<std::uint16_t>(p), surfel.patch, "surfel of patch ", p,
                        " names patch ", surfel.patch);
            }
        }
    }

    // A range of patches is inside the root's because each node's was checked against its parent's.
    void check_region(const OctreeNode& node) const {
        if (node.lod_count == 0) return;
        const auto patches = view_.patches.subspan(node.first_patch, node.patch_count);
        for (const Patch& patch : patches)
            require(patch.material == patches.front().material, node.lod_count,
                    "levels in an octree node whose patches are of several materials");
    }

    // Breadth-first order with contiguous children: each node's children start where the last node's ended, so there
    // can be neither cycles nor nodes that are reached twice or never.
    void check_octree() const {
        require(!view_.octree.empty(), *view_.info, "no octree node, expected a root");
        const OctreeNode& root = view_.octree.front();
        require(root.first_patch == 0 && root.patch_count == view_.patches.size(), root,
                "octree root does not hold all patches");
        std::uint64_t next = 1;
        for (const OctreeNode& node : view_.octree) {
            require(static_cast<std::uint64_t>(&node - view_.octree.data()) < next, node, view_.octree.size(),
                    " octree nodes, ", next, " are reached from the root");
            require(is_box(node), node, "octree bounds are not a box");
            require(node.patch_count > 0, node.patch_count, "octree node without patches");
            check_region(node);
            if (node.child_count == 0) {
                check_leaf(node);
                continue;
            }
            require(node.child_count <= 8, node.child_count, node.child_count, " children of an octree node");
            require(node.first_child == next, node.first_child, "octree children start at ", node.first_child,
                    ", expected ", next);
            require(node.child_count <= view_.octree.size() - next, node.child_count, "octree children beyond the ",
                    view_.octree.size(), " nodes");
            check_children(node, view_.octree.subspan(next, node.child_count));
            next += node.child_count;
        }
        require(next == view_.octree.size(), root, view_.octree.size(), " octree nodes, ", next,
                " are reached from the root");
    }

    void check_leaf(const OctreeNode& node) const {
        require(node.first_child == 0, node.first_child, "octree leaf with a child");
        // Its range is inside the root's because each node's was checked against its parent's.
        for (const Patch& patch : view_.patches.subspan(node.first_patch, node.patch_count))
            require(contains(node, patch), node, "octree leaf does not bound its patches");
    }

    void check_children(const OctreeNode& parent, std::span<const OctreeNode> children) const {
        std::uint64_t patch = parent.first_patch;
        const std::uint64_t end = patch + parent.patch_count;
        for (const OctreeNode& child : children) {
            require(child.first_patch == patch && child.patch_count <= end - patch, child,
                    "octree children do not divide their parent's patches");
            require(contains(parent, child), child, "octree node leaves its parent's bounds");
            patch += child.patch_count;
        }
        require(patch == end, parent, "octree children do not divide their parent's patches");
    }

    void check_merge_tree() const {
        const std::uint64_t leaves = view_.info->source_triangles;
        std::vector<bool> has_parent(leaves + view_.merge_tree.size());
        for (std::uint64_t i = 0; i < view_.merge_tree.size(); ++i) {
            const MergeNode& node = view_.merge_tree[i];
            for (const std::uint32_t& child : node.child) {
                require(child < leaves + i, child, "merge tree: child ", child, " of node ", leaves + i,
                        " does not come before it");
                require(!has_parent[child], child, "merge tree: node ", child, " has two parents");
                has_parent[child] = true;
            }
            require(std::isfinite(node.cost), node.cost, "merge cost is not finite");
            require(node.phase == 1 || node.phase == 2, node.phase, "merge phase ", node.phase, ", expected 1 or 2");
        }
    }

    // As check_octree(): what is not stored follows from the counts once they add up.
    void check_point_tree() const {
        if (view_.point_tree.empty()) return;
        std::uint64_t next = 1, surfels = 0;
        for (const PackedPointNode& node : view_.point_tree) {
            require(node.place[1] >> 28 == 0, node, "point node's spare bits are not 0");
            for (const std::uint16_t& length : {std::cref(node.major), std::cref(node.sphere_radius)})
                require(is_length(float_from_half(length)) && length < 0x8000, length,
                        "point node's length is no length");
            constexpr unsigned kInner = kMostLeafSurfels + 1;
            require(node.below != 0 && node.below != kInner, node.below, "point node without surfels");
            if (node.below < kInner) {
                surfels += node.below;
                continue;
            }
            const unsigned children = node.below - kInner;
            require(children <= 8, node.below, children, " children of a point node");
            require(children <= view_.point_tree.size() - next, node.below, "point node's children beyond the ",
                    view_.point_tree.size(), " nodes");
            next += children;
        }
        const PackedPointNode& root = view_.point_tree.front();
        require(next == view_.point_tree.size(), root, view_.point_tree.size(), " point nodes, ", next,
                " are reached from the root");
        require(surfels == view_.surfel_count(), root, view_.surfel_count(), " surfels, the point tree has ", surfels);
    }

    const ModelView& view_;
    const std::byte* base_;
    const std::string& name_;
};

}  // namespace

void validate_model(const ModelView& view, const std::byte* base, const std::string& name) {
    Validator(view, base, name).run();
}

}  // namespace splice
