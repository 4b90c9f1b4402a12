// Disks end where the surface they stand for ends, and nowhere else.
#include "preprocess/model_format/octahedral.h"
#include "preprocess/model_format/surfel_clip.h"
#include "preprocess/model_format/tangent_frame.h"
#include "preprocess/surfel/disk_clip.h"
#include "tests/surfel/surfel_fixture.h"

#include <catch2/catch.hpp>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

using namespace splice;
using namespace splice::test;

namespace {

SamplingOptions fixed_spacing(double h) {
    SamplingOptions options;
    options.h_min = options.h_max = h;
    return options;
}

/// Calls visit(point) for points of the part of the disk that is kept.
template <typename Visit>
void for_each_point(const SurfelSample& surfel, Visit&& visit) {
    const auto stored = decode_octahedral(encode_octahedral(surfel.normal.x(), surfel.normal.y(), surfel.normal.z()));
    const auto [s, t] = tangents_of(stored);
    const SurfelClip clip = decode_clip(surfel.clip);
    for (float u = -1; u <= 1; u += 0.125f) {
        for (float v = -1; v <= 1; v += 0.125f) {
            if (u * u + v * v > 1 || clip.x * u + clip.y * v > clip.offset) continue;
            visit(Vec3f(surfel.position + surfel.radius * (u * Vec3f(s[0], s[1], s[2]) + v * Vec3f(t[0], t[1], t[2]))));
        }
    }
}

}  // namespace

TEST_CASE("disks at the edges of a cube are cut there", "[surfel]") {
    const IndexedMesh mesh = repaired(shapes::cube(6));
    const SurfelSet set = sample_patches(mesh, one_patch(mesh), fixed_spacing(0.1));
    CHECK(set.stats.uncovered == 0);
    const float half = mesh.positions[0].cwiseAbs().maxCoeff();
    std::size_t cut = 0;
    double overhang = 0, whole_overhang = 0;
    for (const SurfelSample& surfel : set.surfels) {
        cut += surfel.clip != kNoClip ? 1 : 0;
        SurfelSample whole = surfel;
        whole.clip = kNoClip;
        for_each_point(surfel, [&](const Vec3f& p) { overhang += p.cwiseAbs().maxCoeff() > half + 0.002f ? 1 : 0; });
        for_each_point(whole,
                       [&](const Vec3f& p) { whole_overhang += p.cwiseAbs().maxCoeff() > half + 0.002f ? 1 : 0; });
    }
    CHECK(cut > set.surfels.size() / 10);
    CHECK(cut < set.surfels.size() * 9 / 10);
    CHECK(whole_overhang > 100);
    // What is left hangs over at corners, which one line cannot follow.
    CHECK(overhang < 0.15 * whole_overhang);
}

TEST_CASE("disks of a smooth surface are whole, across the borders of patches too", "[surfel]") {
    const IndexedMesh mesh = repaired(shapes::bumpy_sphere(40000));
    const SurfelSet set = sample_patches(mesh, patches_by_cell(mesh, 4), fixed_spacing(1.0 / 40));
    CHECK(set.stats.uncovered == 0);
    const auto cut = std::count_if(set.surfels.begin(), set.surfels.end(),
                                   [](const SurfelSample& surfel) { return surfel.clip != kNoClip; });
    CHECK(static_cast<double>(cut) < 0.02 * static_cast<double>(set.surfels.size()));
}

TEST_CASE("disks at an open border do not hang over it", "[surfel]") {
    // A square in the plane z = 0.
    const IndexedMesh mesh = mesh_of({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, {{0, 1, 2}, {0, 2, 3}});
    const SurfelSet set = sample_patches(mesh, one_patch(mesh), fixed_spacing(0.1));
    CHECK(set.stats.uncovered == 0);
    double beyond = 0;
    for (const SurfelSample& surfel : set.surfels) {
        const bool corner = surfel.position.head<2>().cwiseAbs().minCoeff() > 0.5f - surfel.radius;
        if (corner) continue;
        for_each_point(surfel, [&](const Vec3f& p) { beyond = std::max(beyond, double{p.cwiseAbs().maxCoeff()}); });
    }
    CHECK(beyond > 0.49);
    CHECK(beyond < 0.51);
}

TEST_CASE("the surface goes on across flat edges of two triangles alone", "[surfel]") {
    // Two triangles that share an edge, and a fin on one of their outer edges shared by two more.
    const IndexedMesh mesh = mesh_of({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}, {0.5, 0, 1}, {0.5, 0, -1}},
                                     {{0, 1, 2}, {1, 3, 2}, {0, 1, 4}, {0, 1, 5}});
    const SmoothNeighbours neighbours = find_smooth_neighbours(mesh);
    REQUIRE(neighbours.size() == 4);
    std::size_t links = 0;
    for (std::uint32_t t = 0; t < 4; ++t) {
        for (const std::uint32_t n : neighbours[t]) {
            if (n == kNoTriangle) continue;
            ++links;
            CHECK(std::count(neighbours[n].begin(), neighbours[n].end(), t) == 1);
        }
    }
    CHECK(links == 2);
}
