#include "preprocess/build_model/assemble_cloud.h"

#include "preprocess/build_model/normal_cone.h"
#include "preprocess/build_model/patch_octree.h"
#include "preprocess/large_vector.h"
#include "preprocess/lod/point_octree.h"
#include "preprocess/model_format/half.h"
#include "preprocess/model_format/octahedral.h"
#include "preprocess/model_format/packed_surfel.h"
#include "preprocess/model_format/point_node.h"
#include "preprocess/model_format/surfel_extent.h"

#include <tbb/parallel_for.h>

#include <algorithm>

namespace splice {
namespace {

Vec3f stored_normal(const format::Surfel& surfel) {
    const auto normal = decode_octahedral(surfel.normal);
    return {normal[0], normal[1], normal[2]};
}

format::PackedSurfel make_surfel(const Vec3f& position, const CloudDisk& disk, std::uint32_t colour) {
    format::Surfel surfel{};
    for (int axis = 0; axis < 3; ++axis) {
        surfel.position[axis] = position[axis];
        surfel.colour[axis] = static_cast<std::uint8_t>(colour >> (8 * axis));
    }
    surfel.radius = half_at_least(disk.radius);
    surfel.extent = encode_extent({disk.above, disk.below, 0}, float_from_half(surfel.radius));
    surfel.normal = encode_octahedral(disk.normal.x(), disk.normal.y(), disk.normal.z());
    return pack_surfel(surfel);
}

class Assembler {
  public:
    Assembler(const UnitCloud& cloud, const CloudSurface& surface) : cloud_(cloud), surface_(surface) {}

    Model assemble() {
        PointSplit split = split_points(cloud_.positions);
        make_surfels(split.order);
        std::vector<std::uint32_t>().swap(split.order);
        nodes_ = bound_point_octree(model_.surfels, std::move(split));
        cut_patches();
        bounds_.resize(model_.patches.size());
        tbb::parallel_for(std::size_t{0}, model_.patches.size(), [&](std::size_t patch) { measure_patch(patch); });
        model_.octree = build_octree_in_order(bounds_);
        model_.lods.resize(model_.patches.size());
        model_.materials.push_back({kWhite, format::kNoTexture});
        add_info();
        pack();
        return std::move(model_);
    }

  private:
    void make_surfels(const std::vector<std::uint32_t>& order) {
        model_.surfels = large_vector<format::Surfel>(order.size());
        model_.packed_surfels = large_vector<format::PackedSurfel>(order.size());
        tbb::parallel_for(std::size_t{0}, order.size(), [&](std::size_t place) {
            const std::uint32_t point = order[place], colour = cloud_.colours.empty() ? kWhite : cloud_.colours[point];
            model_.packed_surfels[place] = make_surfel(cloud_.positions[point], surface_.disks[point], colour);
            // What packing changes is changed before anything is bounded by it.
            model_.surfels[place] = unpack_surfel(model_.packed_surfels[place], 0);
        });
    }

    // Patches are the largest nodes of the tree that are small enough, small siblings together.
    void cut_patches() { cut_patches(0); }

    void cut_patches(std::uint32_t index) {
        const format::PointNode& node = nodes_[index];
        if (node.surfel_count <= kCloudPatchPoints) return add_patch(node);
        const format::PointNode* before = nullptr;
        for (std::uint32_t child = 0; child < node.child_count; ++child) {
            const format::PointNode& part = nodes_[node.first_child + child];
            if (part.surfel_count > kCloudPatchPoints) {
                cut_patches(node.first_child + child);
                before = nullptr;
            } else if (before != nullptr &&
                       model_.patches.back().surfel_count + part.surfel_count <= kCloudPatchPoints) {
                model_.patches.back().surfel_count += part.surfel_count;
            } else {
                add_patch(part);
                before = &part;
            }
        }
    }

    void add_patch(const format::PointNode& node) {
        format::Patch patch{};
        patch.representation = format::Representation::kSurfels;
        patch.first_surfel = node.first_surfel;
        patch.surfel_count = node.surfel_count;
        patch.first_lod = static_cast<std::uint32_t>(model_.patches.size());
        patch.lod_count = 1;
        model_.patches.push_back(patch);
    }

    void measure_patch(std::size_t index) {
        format::Patch& patch = model_.patches[index];
        Box& box = bounds_[index];
        std::vector<Vec3f> normals;
        normals.reserve(patch.surfel_count);
        for (std::uint32_t i = 0; i < patch.surfel_count; ++i) {
            format::Surfel& surfel = model_.surfels[patch.first_surfel + i];
            surfel.patch = static_cast<std::uint16_t>(index);
            normals.push_back(stored_normal(surfel));
            const float radius = float_from_half(surfel.radius);
            // The extent of a disk along an axis is r sqrt(1 - n^2); widened by its rounding.
            const Vec3f reach = (Vec3f::Ones() - normals.back().cwiseAbs2()).cwiseMax(0.0f).cwiseSqrt() * radius +
                                Vec3f::Constant(1e-6f);
            const Vec3f position(surfel.position[0], surfel.position[1], surfel.position[2]);
            box.add(position - reach);
            box.add(position + reach);
            patch.max_surfel_radius = std::max(patch.max_surfel_radius, radius);
            patch.max_surfel_epsilon = std::max(patch.max_surfel_epsilon, decode_extent(surfel.extent, radius).epsilon);
        }
        const NormalCone cone = enclose_normals(normals);
        for (int axis = 0; axis < 3; ++axis) {
            patch.bounds_min[axis] = box.min[axis];
            patch.bounds_max[axis] = box.max[axis];
            patch.cone_axis[axis] = cone.axis[axis];
        }
        patch.cone_cos = cone.cosine;
    }

    void add_info() {
        format::ModelInfo& info = model_.info;
        info.source_scale = cloud_.source_scale;
        for (int axis = 0; axis < 3; ++axis) {
            info.source_offset[axis] = cloud_.source_offset[axis];
            info.bounds_min[axis] = model_.octree.front().bounds_min[axis];
            info.bounds_max[axis] = model_.octree.front().bounds_max[axis];
        }
        info.flags = format::kPointCloud | format::kTwoSided;
        if (!cloud_.colours.empty()) info.flags |= format::kHasColours;
        info.lod_levels = 1;
        info.source_vertices = cloud_.positions.size();
        info.median_surfel_radius = median_radius();
        for (const format::Patch& patch : model_.patches)
            info.max_surfel_radius = std::max(info.max_surfel_radius, patch.max_surfel_radius);
    }

    void pack() {
        model_.point_tree = large_vector<format::PackedPointNode>(nodes_.size());
        tbb::parallel_for(std::size_t{0}, nodes_.size(),
                          [&](std::size_t i) { model_.point_tree[i] = pack_point_node(nodes_[i]); });
        std::vector<format::Surfel>().swap(model_.surfels);
    }

    // Halves above 0 are ordered as their bits are, so counting them sorts them.
    float median_radius() const {
        std::vector<std::uint64_t> counts(std::size_t{1} << 16);
        for (const format::Surfel& surfel : model_.surfels)
            ++counts[surfel.radius];
        std::uint64_t smaller = 0;
        std::uint32_t radius = 0;
        while (smaller + counts[radius] <= model_.surfels.size() / 2)
            smaller += counts[radius++];
        return float_from_half(static_cast<std::uint16_t>(radius));
    }

    const UnitCloud& cloud_;
    const CloudSurface& surface_;
    std::vector<format::PointNode> nodes_;
    std::vector<Box> bounds_;
    Model model_;
};

}  // namespace

Model assemble_cloud(const UnitCloud& cloud, const CloudSurface& surface) {
    return Assembler(cloud, surface).assemble();
}

}  // namespace splice
