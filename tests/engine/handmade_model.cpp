#include "tests/engine/handmade_model.h"

#include "preprocess/model_format/half.h"
#include "preprocess/model_format/octahedral.h"
#include "preprocess/model_format/surfel_extent.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace splice::test {

HandmadeModel::HandmadeModel(bool two_sided) {
    model_.info.source_scale = 1;
    model_.info.flags = two_sided ? format::kTwoSided : 0u;
    model_.info.lod_levels = 1;
    model_.materials.push_back({0xffffffff, format::kNoTexture});
}

void HandmadeModel::extend(format::Patch& patch, const glm::vec3& point, float radius) {
    for (int axis = 0; axis < 3; ++axis) {
        patch.bounds_min[axis] = std::min(patch.bounds_min[axis], point[axis] - radius);
        patch.bounds_max[axis] = std::max(patch.bounds_max[axis], point[axis] + radius);
    }
}

namespace {

format::Patch empty_patch(format::Representation representation) {
    format::Patch patch{};
    patch.representation = representation;
    for (int axis = 0; axis < 3; ++axis) {
        patch.bounds_min[axis] = 1e30f;
        patch.bounds_max[axis] = -1e30f;
    }
    patch.cone_axis[2] = 1;
    patch.cone_cos = -1;
    patch.lod_count = 1;
    return patch;
}

}  // namespace

HandmadeModel& HandmadeModel::add_surfels(const std::vector<Disk>& disks) {
    format::Patch patch = empty_patch(format::Representation::kSurfels);
    patch.first_surfel = model_.surfels.size();
    patch.surfel_count = static_cast<std::uint32_t>(disks.size());
    patch.first_lod = static_cast<std::uint32_t>(model_.lods.size());
    model_.lods.push_back({model_.indices.size(), 0, 0});
    for (const Disk& disk : disks) {
        format::Surfel surfel{};
        std::memcpy(surfel.position, &disk.centre, sizeof surfel.position);
        surfel.radius = half_at_least(disk.radius);
        surfel.normal = encode_octahedral(disk.normal.x, disk.normal.y, disk.normal.z);
        for (int channel = 0; channel < 3; ++channel)
            surfel.colour[channel] = static_cast<std::uint8_t>(disk.colour >> 8 * channel);
        surfel.clip = disk.clip;
        surfel.extent = encode_extent({disk.above, disk.below, disk.epsilon}, float_from_half(surfel.radius));
        surfel.patch = static_cast<std::uint16_t>(model_.patches.size());
        model_.surfels.push_back(surfel);
        extend(patch, disk.centre, float_from_half(surfel.radius));
        patch.max_surfel_radius = std::max(patch.max_surfel_radius, float_from_half(surfel.radius));
        patch.max_surfel_epsilon =
            std::max(patch.max_surfel_epsilon, decode_extent(surfel.extent, float_from_half(surfel.radius)).epsilon);
    }
    model_.patches.push_back(patch);
    return *this;
}

HandmadeModel& HandmadeModel::add_triangles(const std::vector<Corner>& corners, std::uint32_t material) {
    format::Patch patch = empty_patch(format::Representation::kTriangles);
    patch.material = material;
    patch.first_surfel = model_.surfels.size();
    patch.first_lod = static_cast<std::uint32_t>(model_.lods.size());
    model_.lods.push_back({model_.indices.size(), static_cast<std::uint32_t>(corners.size()), 0});
    for (const Corner& corner : corners) {
        format::Vertex vertex{};
        std::memcpy(vertex.position, &corner.position, sizeof vertex.position);
        vertex.normal = encode_octahedral(corner.normal.x, corner.normal.y, corner.normal.z);
        vertex.colour = corner.colour;
        std::memcpy(vertex.uv, &corner.uv, sizeof vertex.uv);
        model_.indices.push_back(static_cast<std::uint32_t>(model_.vertices.size()));
        model_.vertices.push_back(vertex);
        extend(patch, corner.position, 0);
    }
    model_.info.drawn_triangles += corners.size() / 3;
    model_.patches.push_back(patch);
    return *this;
}

std::uint32_t HandmadeModel::add_texture(std::uint32_t width, std::uint32_t height,
                                         const std::vector<std::uint32_t>& texels) {
    const auto bytes = std::as_bytes(std::span(texels));
    model_.textures.push_back({width, height, 1, 0, model_.texels.size(), bytes.size()});
    model_.texels.insert(model_.texels.end(), bytes.begin(), bytes.end());
    model_.materials.push_back({0xffffffff, static_cast<std::uint32_t>(model_.textures.size() - 1)});
    return static_cast<std::uint32_t>(model_.materials.size() - 1);
}

const Model& HandmadeModel::model() {
    format::OctreeNode root{};
    for (int axis = 0; axis < 3; ++axis) {
        root.bounds_min[axis] = 1e30f;
        root.bounds_max[axis] = -1e30f;
        for (const format::Patch& patch : model_.patches) {
            root.bounds_min[axis] = std::min(root.bounds_min[axis], patch.bounds_min[axis]);
            root.bounds_max[axis] = std::max(root.bounds_max[axis], patch.bounds_max[axis]);
        }
        model_.info.bounds_min[axis] = root.bounds_min[axis];
        model_.info.bounds_max[axis] = root.bounds_max[axis];
    }
    // Every patch counts as one source triangle, which is its own merge root.
    model_.info.source_triangles = model_.patches.size();
    for (std::size_t i = 0; i < model_.patches.size(); ++i)
        model_.patches[i].merge_root = static_cast<std::uint32_t>(i);
    for (const format::Patch& patch : model_.patches)
        model_.info.max_surfel_radius = std::max(model_.info.max_surfel_radius, patch.max_surfel_radius);
    model_.info.median_surfel_radius = model_.info.max_surfel_radius;
    root.patch_count = static_cast<std::uint32_t>(model_.patches.size());
    model_.octree = {root};
    return model_;
}

std::vector<Corner> quad(const glm::vec3& origin, const glm::vec3& along, const glm::vec3& up, std::uint32_t colour) {
    const glm::vec3 normal = glm::normalize(glm::cross(along, up));
    const auto corner = [&](float u, float v) {
        return Corner{origin + u * along + v * up, normal, {u, 1 - v}, colour};
    };
    return {corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 0), corner(1, 1), corner(0, 1)};
}

std::vector<Disk> sheet(const glm::vec3& origin, const glm::vec3& along, const glm::vec3& up, int count,
                        std::uint32_t colour) {
    const glm::vec3 normal = glm::cross(along, up);
    const float spacing = std::max(glm::length(along), glm::length(up)) / static_cast<float>(count);
    std::vector<Disk> disks;
    for (int row = 0; row <= count; ++row) {
        for (int column = 0; column <= count; ++column) {
            const glm::vec3 centre = origin + along * (static_cast<float>(column) / static_cast<float>(count)) +
                                     up * (static_cast<float>(row) / static_cast<float>(count));
            disks.push_back({centre, normal, 0.9f * spacing, spacing, colour});
        }
    }
    return disks;
}

}  // namespace splice::test
