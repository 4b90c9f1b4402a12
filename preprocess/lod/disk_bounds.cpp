// Compiled without contraction to fused multiply-adds.
#include "preprocess/lod/disk_bounds.h"

#include "preprocess/lod/bounding_ellipse.h"
#include "preprocess/model_format/half.h"
#include "preprocess/model_format/octahedral.h"
#include "preprocess/model_format/surfel_extent.h"

#include <algorithm>
#include <cmath>

namespace splice {
namespace {

constexpr std::size_t kStep = DiskArrays::kStep;
using Lanes = std::array<float, kStep>;

float larger(float a, float b) {
    return a < b ? b : a;
}
float smaller(float a, float b) {
    return a < b ? a : b;
}
float root(float square) {
    return std::sqrt(larger(square, 0.0f));
}

}  // namespace

void DiskArrays::clear() {
    for (auto& values : component_)
        values.clear();
}

void DiskArrays::add(const format::Surfel& surfel) {
    const float radius = float_from_half(surfel.radius);
    const SurfelExtent extent = decode_extent(surfel.extent, radius);
    const auto normal = decode_octahedral(surfel.normal);
    const float height = larger(extent.above, extent.below);
    const std::array<float, kComponents> values{surfel.position[0],
                                                surfel.position[1],
                                                surfel.position[2],
                                                normal[0],
                                                normal[1],
                                                normal[2],
                                                radius,
                                                extent.above,
                                                extent.below,
                                                std::sqrt(radius * radius + height * height)};
    for (std::size_t i = 0; i < kComponents; ++i)
        component_[i].push_back(values[i]);
}

void DiskArrays::fill_step() {
    while (size() % kStep != 0)
        for (auto& values : component_)
            values.push_back(values.back());
}

DiskBounds bound_disks(const DiskArrays& disks, std::size_t begin, std::size_t end, const NodeFrame& frame) {
    const float *x = disks.of(DiskArrays::kX), *y = disks.of(DiskArrays::kY), *z = disks.of(DiskArrays::kZ),
                *nx = disks.of(DiskArrays::kNx), *ny = disks.of(DiskArrays::kNy), *nz = disks.of(DiskArrays::kNz),
                *radius = disks.of(DiskArrays::kRadius), *above = disks.of(DiskArrays::kAbove),
                *below = disks.of(DiskArrays::kBelow), *sphere = disks.of(DiskArrays::kSphere);
    const auto along = [](const Vec3f& axis, float a, float b, float c) {
        return axis.x() * a + axis.y() * b + axis.z() * c;
    };
    Lanes in_sphere{}, up{}, down{}, largest{}, circle{}, minor{}, cosine;
    cosine.fill(1);
    for (std::size_t first = begin; first < end; first += kStep)
        for (std::size_t lane = 0; lane < kStep; ++lane) {
            const std::size_t i = first + lane;
            const float dx = x[i] - frame.centre.x(), dy = y[i] - frame.centre.y(), dz = z[i] - frame.centre.z();
            const float across = along(frame.normal, nx[i], ny[i], nz[i]), height = along(frame.normal, dx, dy, dz),
                        on_major = along(frame.major, dx, dy, dz), on_minor = along(frame.minor, dx, dy, dz);
            // What a disk reaches along a unit vector.
            const float slant = radius[i] * root(1 - across * across);
            in_sphere[lane] = larger(in_sphere[lane], std::sqrt(dx * dx + dy * dy + dz * dz) + sphere[i]);
            cosine[lane] = smaller(across, cosine[lane]);
            up[lane] = larger(up[lane], height + slant + above[i]);
            down[lane] = larger(down[lane], slant + below[i] - height);
            largest[lane] = larger(largest[lane], radius[i]);
            circle[lane] = larger(circle[lane], std::sqrt(on_major * on_major + on_minor * on_minor) + radius[i]);
        }
    const auto most = [](const Lanes& lanes) { return *std::max_element(lanes.begin(), lanes.end()); };
    DiskBounds bounds{.sphere = most(in_sphere),
                      .cosine = *std::min_element(cosine.begin(), cosine.end()),
                      .above = most(up),
                      .below = most(down),
                      .largest_radius = most(largest),
                      .major = most(circle),
                      .minor = most(circle)};
    // minor_to_hold() of bounding_ellipse.h.
    const float longer = static_cast<float>(kLongerThanCircle) * bounds.major, share = 1 / longer;
    for (std::size_t first = begin; first < end; first += kStep)
        for (std::size_t lane = 0; lane < kStep; ++lane) {
            const std::size_t i = first + lane;
            const float dx = x[i] - frame.centre.x(), dy = y[i] - frame.centre.y(), dz = z[i] - frame.centre.z();
            const float a = along(frame.major, nx[i], ny[i], nz[i]), b = along(frame.minor, nx[i], ny[i], nz[i]);
            const float on_major = std::abs(along(frame.major, dx, dy, dz)),
                        on_minor = std::abs(along(frame.minor, dx, dy, dz));
            const float corner = (on_major + radius[i] * root(1 - a * a)) * share, middle = on_major * share;
            const float rectangle =
                (on_minor + radius[i] * root(1 - b * b)) / std::sqrt(larger(1 - corner * corner, 1e-6f));
            const float rest = 1 - middle * middle;
            const float held =
                (radius[i] + std::sqrt(middle * middle * radius[i] * radius[i] + rest * on_minor * on_minor)) / rest;
            minor[lane] = larger(minor[lane], smaller(rectangle, held));
        }
    // The longer ellipse where it is the smaller one.
    if (longer * most(minor) < bounds.major * bounds.major) {
        bounds.major = longer;
        bounds.minor = most(minor);
    }
    return bounds;
}

}  // namespace splice
