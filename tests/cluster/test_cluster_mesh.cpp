#include "preprocess/mesh/shapes.h"
#include "preprocess/model_format/error.h"
#include "tests/cluster/cluster_fixture.h"

#include <catch2/catch.hpp>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

using namespace splice;
using namespace splice::test;

namespace {

/// Everything but the times.
void require_same(const PatchSet& a, const PatchSet& b) {
    REQUIRE(a.patch_begin == b.patch_begin);
    REQUIRE(a.patch_triangles == b.patch_triangles);
    REQUIRE(a.triangle_patch == b.triangle_patch);
    REQUIRE(a.stats.selection_auc == b.stats.selection_auc);
    REQUIRE(a.merge_tree.size() == b.merge_tree.size());
    REQUIRE(std::memcmp(a.merge_tree.data(), b.merge_tree.data(), a.merge_tree.size() * sizeof(format::MergeNode)) ==
            0);
    for (std::size_t p = 0; p < a.patches.size(); ++p) {
        const ClusterPatch &x = a.patches[p], &y = b.patches[p];
        REQUIRE(x.representation == y.representation);
        REQUIRE(x.area == y.area);
        REQUIRE(x.mean_normal == y.mean_normal);
        REQUIRE(x.roughness == y.roughness);
        REQUIRE(x.merge_root == y.merge_root);
    }
}

std::vector<ClusterOptions> option_sets() {
    std::vector<ClusterOptions> sets(6);
    sets[1].selection = Selection::kThesis;
    sets[2].triangle_share = 0.4;
    sets[3].representation = ForcedRepresentation::kTriangles;
    sets[4].representation = ForcedRepresentation::kSurfels;
    sets[5].selection = Selection::kThesis;
    sets[5].triangle_share = 0.4;
    return sets;
}

}  // namespace

TEST_CASE("Patches partition the mesh, are connected, and are the roots of the merge tree") {
    for (const IndexedMesh& mesh : {random_blob(16, 4), repaired(shapes::bumpy_sphere(5000)),
                                    repaired(shapes::terrain(40)), repaired(shapes::machined_part(32)),
                                    repaired(shapes::cube(10)), repaired(shapes::torus_knot(2, 3, 120, 10))}) {
        for (const ClusterOptions& options : option_sets())
            require_sound(mesh, cluster_mesh(mesh, options));
    }
}

TEST_CASE("The same mesh gives the same patches, whatever the number of threads") {
    const IndexedMesh mesh = repaired(shapes::bumpy_sphere(20000));
    for (const ClusterOptions& options : option_sets()) {
        const PatchSet set = cluster_mesh(mesh, options);
        const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
        require_same(set, cluster_mesh(mesh, options));
    }
}

TEST_CASE("A forced representation leaves no other") {
    const IndexedMesh mesh = repaired(shapes::bumpy_sphere(8000));
    for (const Selection selection : {Selection::kGeometric, Selection::kThesis}) {
        ClusterOptions options;
        options.selection = selection;
        options.triangle_share = 0.5;  // the representation wins
        options.representation = ForcedRepresentation::kTriangles;
        const PatchSet triangles = cluster_mesh(mesh, options);
        CHECK(triangles.stats.surfel_patches == 0);
        CHECK(!triangles.stats.selection_auc);
        CHECK(std::all_of(triangles.merge_tree.begin(), triangles.merge_tree.end(),
                          [](const format::MergeNode& n) { return n.phase == 1; }));
        options.representation = ForcedRepresentation::kSurfels;
        const PatchSet surfels = cluster_mesh(mesh, options);
        CHECK(surfels.stats.triangle_patches == 0);
        CHECK(surfels.stats.triangles_in_triangle_patches == 0);
    }
}

TEST_CASE("The triangle share lands on what was asked for") {
    for (const IndexedMesh& mesh :
         {repaired(shapes::bumpy_sphere(10000)), repaired(shapes::terrain(50)), repaired(shapes::cube(20)),
          repaired(shapes::machined_part(64)), repaired(shapes::uv_sphere(60, 40)), random_blob(30, 8)}) {
        for (const double share : {0.0, 0.01, 0.19, 0.5, 0.75, 0.99, 1.0}) {
            for (const Selection selection : {Selection::kGeometric, Selection::kThesis}) {
                ClusterOptions options;
                options.selection = selection;
                options.triangle_share = share;
                const PatchSet set = cluster_mesh(mesh, options);
                CHECK(triangle_share(mesh, set) == Approx(share).margin(0.01));
                if (share == 0) CHECK(set.stats.triangle_patches == 0);
                if (share == 1) CHECK(set.stats.surfel_patches == 0);
            }
        }
    }
}

TEST_CASE("The triangle share is met to half a triangle on tiny meshes") {
    for (const IndexedMesh& mesh : {repaired(shapes::cube()), repaired(shapes::ico_sphere(1))}) {
        for (int i = 0; i <= 10; ++i) {
            ClusterOptions options;
            options.triangle_share = i / 10.0;
            const double half = 0.5 / static_cast<double>(mesh.triangles.size());
            CHECK(triangle_share(mesh, cluster_mesh(mesh, options)) == Approx(i / 10.0).margin(half + 1e-9));
        }
    }
}

TEST_CASE("No patch outgrows the largest area, nor crumbs it by more than a quarter") {
    const IndexedMesh mesh = repaired(shapes::bumpy_sphere(30000));
    for (const double share : {0.0005, 0.002, 0.02}) {
        ClusterOptions options;
        options.max_patch_area = share;
        const PatchSet set = cluster_mesh(mesh, options);
        double total = 0, largest = 0;
        for (const ClusterPatch& p : set.patches) {
            total += static_cast<double>(p.area);
            largest = std::max(largest, static_cast<double>(p.area));
        }
        CHECK(largest <= 1.2501 * share * total);
        CHECK(static_cast<double>(set.patches.size()) >= 0.8 / share);
        CHECK(static_cast<double>(set.patches.size()) <= 6 / share);
    }
}

TEST_CASE("Larger phase costs merge more, in both selections") {
    const IndexedMesh mesh = repaired(shapes::terrain(50));
    for (const Selection selection : {Selection::kGeometric, Selection::kThesis}) {
        for (const auto member : {&ClusterOptions::phase1_cost, &ClusterOptions::phase2_cost}) {
            std::size_t before = std::numeric_limits<std::size_t>::max();
            for (const double cost : {-1.0, -0.1, 0.2, 0.8, 2.0}) {
                ClusterOptions options;
                options.selection = selection;
                options.representation = ForcedRepresentation::kSurfels;
                options.max_patch_area = 0.01;
                options.*member = cost;
                const std::size_t patches = cluster_mesh(mesh, options).patches.size();
                // Greedy contraction may end in a few clusters more at a larger threshold.
                CHECK(static_cast<double>(patches) <= 1.1 * static_cast<double>(before));
                before = patches;
            }
        }
    }
}

TEST_CASE("In thesis mode phase two's threshold goes from all triangles to all surfels") {
    const IndexedMesh mesh = repaired(shapes::terrain(40));
    ClusterOptions options;
    options.selection = Selection::kThesis;
    options.phase2_cost = -1000;
    CHECK(cluster_mesh(mesh, options).stats.surfel_patches == 0);
    options.phase2_cost = 1e6;
    const PatchSet surfels = cluster_mesh(mesh, options);
    CHECK(surfels.stats.triangle_patches == 0);
    CHECK(surfels.patches.size() == 1);
}

TEST_CASE("Patches keep to one material") {
    IndexedMesh mesh = repaired(shapes::cube(12));
    mesh.materials.resize(3);
    mesh.triangle_material.resize(mesh.triangles.size());
    for (std::size_t f = 0; f < mesh.triangles.size(); ++f) {
        mesh.triangle_material[f] = mesh.positions[mesh.triangles[f][0]].x() > 0.1f ? 2 : 1;
    }
    for (const ClusterOptions& options : option_sets())
        require_sound(mesh, cluster_mesh(mesh, options));
}

TEST_CASE("Options out of range are refused") {
    const IndexedMesh mesh = repaired(shapes::cube());
    const double nan = std::numeric_limits<double>::quiet_NaN();
    for (const double bad : {-0.01, 1.01, nan}) {
        ClusterOptions options;
        options.triangle_share = bad;
        CHECK_THROWS_AS(cluster_mesh(mesh, options), UsageError);
    }
    for (const double bad : {0.0, -1.0, 1.5, nan}) {
        ClusterOptions options;
        options.max_patch_area = bad;
        CHECK_THROWS_AS(cluster_mesh(mesh, options), UsageError);
    }
    ClusterOptions options;
    options.phase1_cost = nan;
    CHECK_THROWS_AS(cluster_mesh(mesh, options), UsageError);
}

TEST_CASE("Progress rises to at most one") {
    double last = 0;
    std::size_t calls = 0;
    cluster_mesh(repaired(shapes::bumpy_sphere(20000)), {}, [&](std::string_view stage, double fraction) {
        CHECK(stage == "cluster");
        CHECK(fraction >= last);
        CHECK(fraction <= 1);
        last = fraction;
        ++calls;
    });
    CHECK(calls > 0);
}
