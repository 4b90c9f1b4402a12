// No point of a surfel patch may be bare, whatever the mesh and the mode.
#include "preprocess/cluster/cluster_mesh.h"
#include "preprocess/surfel/coverage.h"
#include "preprocess/surfel/morton.h"
#include "preprocess/surfel/surface_point.h"
#include "tests/support/test_files.h"
#include "tests/surfel/surfel_fixture.h"

#include <catch2/catch.hpp>

#include <Eigen/Geometry>
#include <numbers>
#include <random>

using namespace splice;
using namespace splice::test;

namespace {

constexpr std::size_t kPoints = 5000;
constexpr std::uint64_t kFreshSeed = 77;  // not the sampler's own

std::vector<std::pair<std::string, SamplingOptions>> modes() {
    SamplingOptions adaptive, unpruned, thesis, thesis_unpruned, coarse;
    for (auto* options : {&adaptive, &unpruned, &thesis, &thesis_unpruned}) {  // few disks, so that it is fast
        options->h_min = 1.0 / 64;
        options->h_max = 1.0 / 20;
    }
    unpruned.prune = thesis_unpruned.prune = false;
    thesis.thesis_c = thesis_unpruned.thesis_c = 2;
    coarse.h_min = coarse.h_max = 0.1;
    return {{"adaptive", adaptive},
            {"adaptive, not pruned", unpruned},
            {"thesis", thesis},
            {"thesis, not pruned", thesis_unpruned},
            {"coarse", coarse}};
}

void check_invariants(const IndexedMesh& mesh, const PatchSet& patches, const SurfelSet& set) {
    REQUIRE(set.patch_begin.size() == patches.patches.size() + 1);
    REQUIRE(set.patch_begin.front() == 0);
    REQUIRE(set.patch_begin.back() == set.surfels.size());
    CHECK(set.stats.surfels == set.surfels.size());
    for (std::size_t p = 0; p < patches.patches.size(); ++p) {
        const auto first = set.patch_begin[p], end = set.patch_begin[p + 1];
        REQUIRE(first <= end);
        if (patches.patches[p].representation == format::Representation::kTriangles) {
            REQUIRE(first == end);
            continue;
        }
        REQUIRE(first < end);
        Vec3f low = set.surfels[first].position, high = low;
        for (auto s = first; s < end; ++s) {
            low = low.cwiseMin(set.surfels[s].position);
            high = high.cwiseMax(set.surfels[s].position);
        }
        std::uint32_t before = 0;
        bool sane = true, ordered = true;
        for (auto s = first; s < end; ++s) {
            const auto& surfel = set.surfels[s];
            sane &= surfel.position.allFinite() && std::abs(surfel.normal.norm() - 1) < 1e-4f && surfel.radius > 0 &&
                    surfel.radius < 1 && surfel.epsilon > 0 && surfel.epsilon < 1;
            const auto code = morton_code(surfel.position, low, (high - low).maxCoeff());
            ordered &= code >= before;
            before = code;
        }
        CHECK(sane);
        CHECK(ordered);
    }
    // On the surface: some triangle of the patch is as near as rounding allows. A sample is enough.
    bool on_surface = true;
    for (std::size_t s = 0; s < set.surfels.size(); s += 1 + set.surfels.size() / 20) {
        const auto patch = static_cast<std::size_t>(
            std::upper_bound(set.patch_begin.begin(), set.patch_begin.end(), s) - set.patch_begin.begin() - 1);
        float nearest = 1;
        for (auto i = patches.patch_begin[patch]; i < patches.patch_begin[patch + 1]; ++i) {
            const auto t = patches.patch_triangles[i];
            nearest = std::min(
                nearest,
                (point_at(mesh, t, barycentric(mesh, t, set.surfels[s].position)) - set.surfels[s].position).norm());
        }
        on_surface &= nearest < 1e-6f;
    }
    CHECK(on_surface);
}

// Whether every one of `count` random points lies in the solid of a disk of its own patch: within the disk's radius,
// and no farther above or below its plane than the disk says. A ray that meets the surface there meets that solid.
bool solids_hold_surface(const IndexedMesh& mesh, const PatchSet& patches, const SurfelSet& set, std::size_t count) {
    constexpr float kSlack = 3e-6f;  // rounding of positions
    std::mt19937 random(6);
    std::uniform_real_distribution<float> uniform(0, 1);
    for (std::size_t p = 0; p < patches.patches.size(); ++p) {
        const auto first = set.patch_begin[p], end = set.patch_begin[p + 1];
        if (first == end) continue;
        const auto begin = patches.patch_begin[p], triangles = patches.patch_begin[p + 1] - begin;
        for (std::size_t i = 0; i < count / patches.patches.size() + 1; ++i) {
            const auto t = patches.patch_triangles[begin + random() % triangles];
            float a = uniform(random), b = uniform(random);
            if (a + b > 1) {
                a = 1 - a;
                b = 1 - b;
            }
            const Vec3f point = point_at(mesh, t, {1 - a - b, a, b});
            const bool held =
                std::any_of(set.surfels.begin() + static_cast<std::ptrdiff_t>(first),
                            set.surfels.begin() + static_cast<std::ptrdiff_t>(end), [&](const SurfelSample& surfel) {
                                const Vec3f d = point - surfel.position;
                                const float height = d.dot(surfel.normal);
                                return (d - height * surfel.normal).norm() <= surfel.radius + kSlack &&
                                       height <= surfel.above + kSlack && -height <= surfel.below + kSlack;
                            });
            if (!held) return false;
        }
    }
    return true;
}

// The same measure without a grid: every point against every disk.
Coverage brute_force_coverage(const IndexedMesh& mesh, const SurfelSet& set, std::size_t count) {
    std::vector<double> area;
    for (const auto& v : mesh.triangles) {
        area.push_back(
            (mesh.positions[v[1]] - mesh.positions[v[0]]).cross(mesh.positions[v[2]] - mesh.positions[v[0]]).norm());
    }
    std::mt19937 random(5);
    std::discrete_distribution<std::uint32_t> pick(area.begin(), area.end());
    std::uniform_real_distribution<float> uniform(0, 1);
    Coverage coverage;
    for (std::size_t i = 0; i < count; ++i) {
        const auto t = pick(random);
        float a = uniform(random), b = uniform(random);
        if (a + b > 1) {
            a = 1 - a;
            b = 1 - b;
        }
        const Vec3f point = point_at(mesh, t, {1 - a - b, a, b});
        std::size_t disks = 0;
        for (const auto& surfel : set.surfels) {
            const Vec3f d = point - surfel.position;
            const float off = std::abs(d.dot(surfel.normal));
            const float along = (d - d.dot(surfel.normal) * surfel.normal).norm();
            if (along <= surfel.radius && off <= surfel.radius && surfel.normal.dot(face_normal(mesh, t)) >= 0.5f)
                ++disks;
        }
        coverage.mean += static_cast<double>(disks) / static_cast<double>(count);
        coverage.uncovered += disks == 0 ? 1.0 / static_cast<double>(count) : 0;
    }
    return coverage;
}

}  // namespace

TEST_CASE("awkward meshes are covered in every mode", "[surfel]") {
    for (const auto& [name, mesh] : awkward_meshes()) {
        for (const auto& [mode, options] : modes()) {
            INFO(name << ", " << mode);
            for (const auto& patches : {one_patch(mesh), patches_by_cell(mesh, 4, true)}) {
                const SurfelSet set = sample_patches(mesh, patches, options);
                check_invariants(mesh, patches, set);
                CHECK(measure_coverage(mesh, patches, set, kPoints, kFreshSeed).value().uncovered == 0);
                CHECK(set.stats.uncovered == 0);
                CHECK(solids_hold_surface(mesh, patches, set, 400));
            }
        }
    }
}

TEST_CASE("the coverage measure agrees with brute force", "[surfel]") {
    const IndexedMesh mesh = repaired(shapes::bumpy_sphere(2000));
    const PatchSet patches = one_patch(mesh);
    SamplingOptions options;
    options.h_min = options.h_max = 1.0 / 40;
    options.h_max = 1.0 / 20;
    SurfelSet set = sample_patches(mesh, patches, options);
    const Coverage covered = brute_force_coverage(mesh, set, 2000);
    CHECK(covered.uncovered == 0);
    CHECK(covered.mean == Approx(measure_coverage(mesh, patches, set, kPoints, kFreshSeed).value().mean).epsilon(0.04));

    SECTION("and both see missing disks") {
        std::vector<SurfelSample> kept;
        for (std::size_t s = 0; s < set.surfels.size(); s += 3)
            kept.push_back(set.surfels[s]);
        set.surfels = kept;
        set.patch_begin = {0, kept.size()};
        const double bare = measure_coverage(mesh, patches, set, kPoints, kFreshSeed).value().uncovered;
        CHECK(bare > 0.1);
        CHECK(bare == Approx(brute_force_coverage(mesh, set, 2000).uncovered).epsilon(0.15));
    }
}

TEST_CASE("pruning removes disks and uncovers nothing", "[surfel]") {
    const IndexedMesh mesh = repaired(shapes::bumpy_sphere(2000));
    const PatchSet patches = patches_by_cell(mesh, 3);
    for (const std::optional<double> c : {std::optional<double>{}, std::optional<double>{2.0}}) {
        SamplingOptions options;
        options.thesis_c = c;
        options.h_min = 1.0 / 100;
        const SurfelSet pruned = sample_patches(mesh, patches, options);
        options.prune = false;
        const SurfelSet all = sample_patches(mesh, patches, options);
        CHECK(pruned.stats.candidates == all.stats.candidates);
        CHECK(all.stats.surfels >= all.stats.candidates);
        CHECK(pruned.stats.surfels <= all.stats.surfels);
        CHECK(pruned.stats.coverage_mean.value() < all.stats.coverage_mean.value());
        if (c) CHECK(pruned.stats.surfels < all.stats.surfels / 2);
        CHECK(pruned.stats.uncovered == 0);
        CHECK(all.stats.uncovered == 0);
    }
}

TEST_CASE("disks are few and overlap little", "[surfel]") {
    for (const auto& mesh :
         {repaired(shapes::ico_sphere(30)), repaired(shapes::bumpy_sphere(8000)), repaired(shapes::terrain(40))}) {
        const SurfelSet set = sample_patches(mesh, patches_by_cell(mesh, 3), {});
        CHECK(set.stats.coverage_mean.value() > 1.5);
        CHECK(set.stats.coverage_mean.value() < 2.6);
    }
}

TEST_CASE("disks overlap as little on a turned part, whose wall is slivers", "[surfel]") {
    std::vector<Vec3d> positions;
    std::vector<Triangle> triangles;
    constexpr std::uint32_t kSides = 64;
    for (std::uint32_t i = 0; i < kSides; ++i) {
        const double angle = 2 * std::numbers::pi * i / kSides;
        const std::uint32_t a = 2 * i, b = 2 * ((i + 1) % kSides);
        positions.emplace_back(std::cos(angle), std::sin(angle), 0);
        positions.emplace_back(std::cos(angle), std::sin(angle), 4);
        triangles.push_back({a, b, a + 1});
        triangles.push_back({b, b + 1, a + 1});
    }
    const IndexedMesh mesh = mesh_of(positions, triangles);
    const SurfelSet set = sample_patches(mesh, one_patch(mesh), {});
    CHECK(set.stats.coverage_mean.value() < 2.6);
    CHECK(set.stats.uncovered == 0);
}

TEST_CASE("thesis models are covered with at most 2.8 disks a point", "[surfel]") {
    for (const auto* name : {"meshes/bones.smf", "meshes/cow.smf"}) {
        const auto path = model_file(name);
        if (!path) return;
        RepairReport report;
        const IndexedMesh mesh = repair_mesh(read_mesh_file(*path), {}, report, name);
        ClusterOptions cluster;
        cluster.triangle_share = 0.19;
        const PatchSet patches = cluster_mesh(mesh, cluster);
        const SurfelSet set = sample_patches(mesh, patches, {});
        INFO(name);
        CHECK(set.stats.coverage_mean.value() <= 2.8);
        CHECK(measure_coverage(mesh, patches, set, 100000, kFreshSeed).value().uncovered == 0);
    }
}
