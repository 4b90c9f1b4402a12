#include "engine/bench/bumpy_sphere.h"

#include "preprocess/build_model/normal_cone.h"
#include "preprocess/mesh/shapes.h"
#include "preprocess/model_format/half.h"
#include "preprocess/model_format/octahedral.h"
#include "preprocess/model_format/surfel_extent.h"
#include "preprocess/surfel/morton.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

namespace splice::bench {

namespace {

constexpr std::uint32_t kPatchSurfels = 2048;
constexpr float kReach = 1.2f;  // no radius is larger

struct Sample {
    Vec3f position, normal;
    double area;  // that it stands for
};

// `d`: unit direction.
Sample sample_at(const Vec3d& d, double solid_angle) {
    const double r = shapes::bumpy_radius(d);
    const Vec3d normal = shapes::bumpy_normal(d);
    return {(r * d).cast<float>(), normal.cast<float>(), solid_angle * r * r / normal.dot(d)};
}

std::vector<Sample> lattice(std::uint32_t count) {
    std::vector<Sample> samples;
    const double golden = std::numbers::pi * (3 - std::sqrt(5.0));
    for (std::uint32_t i = 0; i < count; ++i) {
        const double z = 1 - (2.0 * i + 1) / count, ring = std::sqrt(1 - z * z), turn = golden * i;
        samples.push_back(sample_at({ring * std::cos(turn), ring * std::sin(turn), z}, 4 * std::numbers::pi / count));
    }
    std::vector<std::pair<std::uint32_t, std::uint32_t>> order;
    for (std::uint32_t i = 0; i < count; ++i)
        order.emplace_back(morton_code(samples[i].position, Vec3f::Constant(-kReach), 2 * kReach), i);
    std::sort(order.begin(), order.end());
    std::vector<Sample> sorted;
    for (const auto& [code, i] : order)
        sorted.push_back(samples[i]);
    return sorted;
}

format::Surfel surfel_of(const Sample& sample, double depth) {
    format::Surfel surfel{};
    for (int axis = 0; axis < 3; ++axis)
        surfel.position[axis] = sample.position[axis];
    const float radius = static_cast<float>(std::sqrt(depth * sample.area / std::numbers::pi));
    surfel.radius = half_at_least(radius);
    surfel.extent = encode_extent({.epsilon = radius}, float_from_half(surfel.radius));
    surfel.normal = encode_octahedral(sample.normal.x(), sample.normal.y(), sample.normal.z());
    surfel.colour[0] = 0;
    surfel.colour[1] = 137;  // sRGB of a quarter
    surfel.colour[2] = 255;
    return surfel;
}

// As of a bake, so that patches that face away are left out, whatever draws the others.
void enclose_patch_normals(Model& model) {
    for (format::Patch& patch : model.patches) {
        std::vector<Vec3f> normals;
        for (std::uint32_t i = 0; i < patch.surfel_count; ++i) {
            const std::array<float, 3> n = decode_octahedral(model.surfels[patch.first_surfel + i].normal);
            normals.emplace_back(n[0], n[1], n[2]);
        }
        const NormalCone cone = enclose_normals(normals);
        for (int axis = 0; axis < 3; ++axis)
            patch.cone_axis[axis] = cone.axis[axis];
        patch.cone_cos = cone.cosine;
    }
}

}  // namespace

Model bumpy_sphere(std::uint32_t count, double depth) {
    Model model;
    model.info.source_scale = 1;
    model.info.lod_levels = 1;
    model.materials.push_back({0xffffffff, format::kNoTexture});
    model.lods.push_back({0, 0, 0});
    for (const Sample& sample : lattice(count)) {
        if (model.surfels.size() % kPatchSurfels == 0) {
            format::Patch patch{};
            patch.representation = format::Representation::kSurfels;
            std::fill_n(patch.bounds_min, 3, 1e30f);
            std::fill_n(patch.bounds_max, 3, -1e30f);
            patch.lod_count = 1;
            patch.first_surfel = model.surfels.size();
            model.patches.push_back(patch);
        }
        format::Surfel surfel = surfel_of(sample, depth);
        surfel.patch = static_cast<std::uint16_t>(model.patches.size() - 1);
        format::Patch& patch = model.patches.back();
        const float radius = float_from_half(surfel.radius);
        for (int axis = 0; axis < 3; ++axis) {
            patch.bounds_min[axis] = std::min(patch.bounds_min[axis], surfel.position[axis] - radius);
            patch.bounds_max[axis] = std::max(patch.bounds_max[axis], surfel.position[axis] + radius);
            model.info.bounds_min[axis] = std::min(model.info.bounds_min[axis], patch.bounds_min[axis]);
            model.info.bounds_max[axis] = std::max(model.info.bounds_max[axis], patch.bounds_max[axis]);
        }
        patch.max_surfel_radius = std::max(patch.max_surfel_radius, radius);
        ++patch.surfel_count;
        model.surfels.push_back(surfel);
    }
    enclose_patch_normals(model);
    return model;
}

}  // namespace splice::bench
