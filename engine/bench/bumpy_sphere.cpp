#include "engine/bench/bumpy_sphere.h"

#include "preprocess/model_format/half.h"
#include "preprocess/model_format/octahedral.h"
#include "preprocess/model_format/surfel_extent.h"

#include <glm/glm.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

namespace splice::bench {

namespace {

constexpr std::uint32_t kPatchSurfels = 2048;

struct Sample {
    glm::dvec3 position, normal;
    double area;  // that it stands for
};

// The surface is |p| = r(p / |p|); its normal is the direction less the change of r across it.
Sample sample_at(const glm::dvec3& d, double solid_angle) {
    const double a = 7 * d.x, b = 7 * d.y + 1, c = 7 * d.z + 2, e = 31 * d.x + 17 * d.y, f = 29 * d.z;
    const double r = 1 + 0.06 * std::sin(a) * std::sin(b) * std::sin(c) + 0.01 * std::sin(e) * std::sin(f);
    const glm::dvec3 slope =
        0.42 * glm::dvec3(std::cos(a) * std::sin(b) * std::sin(c), std::sin(a) * std::cos(b) * std::sin(c),
                          std::sin(a) * std::sin(b) * std::cos(c)) +
        glm::dvec3(0.31 * std::cos(e) * std::sin(f), 0.17 * std::cos(e) * std::sin(f),
                   0.29 * std::sin(e) * std::cos(f));
    const glm::dvec3 normal = glm::normalize(d - (slope - glm::dot(slope, d) * d) / r);
    return {d * r, normal, solid_angle * r * r / glm::dot(normal, d)};
}

std::uint64_t morton_code(const glm::dvec3& position) {
    std::uint64_t code = 0;
    for (int axis = 0; axis < 3; ++axis) {
        const auto cell = static_cast<std::uint64_t>((position[axis] + 1.2) / 2.4 * 65536);
        for (int bit = 0; bit < 16; ++bit)
            code |= (cell >> bit & 1) << (3 * bit + axis);
    }
    return code;
}

std::vector<Sample> lattice(std::uint32_t count) {
    std::vector<Sample> samples;
    const double golden = std::numbers::pi * (3 - std::sqrt(5.0));
    for (std::uint32_t i = 0; i < count; ++i) {
        const double z = 1 - (2.0 * i + 1) / count, ring = std::sqrt(1 - z * z), turn = golden * i;
        samples.push_back(sample_at({ring * std::cos(turn), ring * std::sin(turn), z}, 4 * std::numbers::pi / count));
    }
    std::vector<std::pair<std::uint64_t, std::uint32_t>> order;
    for (std::uint32_t i = 0; i < count; ++i)
        order.emplace_back(morton_code(samples[i].position), i);
    std::sort(order.begin(), order.end());
    std::vector<Sample> sorted;
    for (const auto& [code, i] : order)
        sorted.push_back(samples[i]);
    return sorted;
}

format::Surfel surfel_of(const Sample& sample, double depth) {
    format::Surfel surfel{};
    for (int axis = 0; axis < 3; ++axis)
        surfel.position[axis] = static_cast<float>(sample.position[axis]);
    const float radius = static_cast<float>(std::sqrt(depth * sample.area / std::numbers::pi));
    surfel.radius = half_at_least(radius);
    surfel.extent = encode_extent({.epsilon = radius}, float_from_half(surfel.radius));
    surfel.normal = encode_octahedral(static_cast<float>(sample.normal.x), static_cast<float>(sample.normal.y),
                                      static_cast<float>(sample.normal.z));
    surfel.colour[0] = 0;
    surfel.colour[1] = 137;  // sRGB of a quarter
    surfel.colour[2] = 255;
    return surfel;
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
            patch.cone_axis[2] = 1;
            patch.cone_cos = -1;
            patch.lod_count = 1;
            patch.first_surfel = model.surfels.size();
            model.patches.push_back(patch);
        }
        format::Surfel surfel = surfel_of(sample, depth);
        surfel.patch = static_cast<std::uint32_t>(model.patches.size() - 1);
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
    return model;
}

}  // namespace splice::bench
