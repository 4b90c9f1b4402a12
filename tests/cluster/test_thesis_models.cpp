// The five models of the thesis, and others of the collection, where it is present.
#include "tests/cluster/cluster_fixture.h"

#include <catch2/catch.hpp>

#include <Eigen/Geometry>
#include <map>
#include <numeric>

using namespace splice;
using namespace splice::test;

namespace {

struct Published {
    const char* name;
    double triangles_kept;  // share, Ni 2005, table 4.3
};
const std::vector<Published> kPublished{
    {"bones.smf", 0.147}, {"cow.smf", 0.264}, {"dragon-50000.smf", 0.188}, {"bunny.smf", 0.188}, {"crater.smf", 0.113}};

Vec3d unit_normal(const IndexedMesh& mesh, std::uint32_t f) {
    const Triangle& t = mesh.triangles[f];
    const Vec3d a = mesh.positions[t[0]].cast<double>();
    return (mesh.positions[t[1]].cast<double>() - a).cross(mesh.positions[t[2]].cast<double>() - a).normalized();
}

/// Components of at least `least` faces joined over edges that bend by less than a quarter of a degree.
std::vector<std::uint32_t> faces_in_planes(const IndexedMesh& mesh, std::size_t least) {
    std::vector<std::uint32_t> parent(mesh.triangles.size()), size(mesh.triangles.size(), 0), result;
    std::iota(parent.begin(), parent.end(), 0u);
    const auto root = [&](std::uint32_t f) {
        while (parent[f] != f)
            f = parent[f] = parent[parent[f]];
        return f;
    };
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> edges;
    for (std::uint32_t f = 0; f < mesh.triangles.size(); ++f) {
        for (int k = 0; k < 3; ++k) {
            const std::uint32_t a = mesh.triangles[f][k], b = mesh.triangles[f][(k + 1) % 3];
            const auto [edge, fresh] = edges.insert({{std::min(a, b), std::max(a, b)}, f});
            if (fresh) continue;
            if ((unit_normal(mesh, f) - unit_normal(mesh, edge->second)).norm() < 0.0044) {
                parent[root(f)] = root(edge->second);
            }
        }
    }
    for (std::uint32_t f = 0; f < mesh.triangles.size(); ++f)
        ++size[root(f)];
    for (std::uint32_t f = 0; f < mesh.triangles.size(); ++f) {
        if (size[root(f)] >= least) result.push_back(f);
    }
    return result;
}

}  // namespace

TEST_CASE("The default choice agrees with the surface on the thesis's models, and so does a share") {
    double sum = 0;
    std::size_t count = 0;
    for (const Published& model : kPublished) {
        const auto mesh = collection_mesh(model.name);
        if (!mesh) return;
        INFO(model.name);
        const PatchSet set = cluster_mesh(*mesh, {});
        require_sound(*mesh, set);
        CHECK(set.stats.selection_auc.value() >= 0.8);
        CHECK(set.stats.triangle_patches > 0);
        CHECK(set.stats.surfel_patches > 100);
        CHECK(set.patches.size() < 5000);
        sum += set.stats.selection_auc.value();
        ++count;

        ClusterOptions options;
        options.triangle_share = 0.19;
        const PatchSet shared = cluster_mesh(*mesh, options);
        CHECK(triangle_share(*mesh, shared) == Approx(0.19).margin(0.005));
        CHECK(shared.stats.selection_auc.value() >= 0.8);
    }
    CHECK(sum / static_cast<double>(count) >= 0.9);
}

TEST_CASE("Thesis mode keeps the published shares of triangles to 10 percentage points") {
    for (const Published& model : kPublished) {
        const auto mesh = collection_mesh(model.name);
        if (!mesh) return;
        INFO(model.name);
        ClusterOptions options;
        options.selection = Selection::kThesis;
        const PatchSet set = cluster_mesh(*mesh, options);
        CHECK(triangle_share(*mesh, set) == Approx(model.triangles_kept).margin(0.1));
        CHECK(set.stats.surfel_patches > 0);
    }
}

TEST_CASE("Fandisk's flat faces are all triangles") {
    const auto mesh = collection_mesh("fandisk.obj");
    if (!mesh) return;
    const PatchSet set = cluster_mesh(*mesh, {});
    const auto flat = faces_in_planes(*mesh, 20);
    REQUIRE(flat.size() > mesh->triangles.size() / 4);
    std::size_t surfels = 0;
    for (const std::uint32_t f : flat) {
        surfels += set.patches[set.triangle_patch[f]].representation == format::Representation::kSurfels;
    }
    CHECK(surfels == 0);
}

TEST_CASE("A large floor is triangles and leaves the statue on it finely cut") {
    const auto mesh = collection_mesh("dragon-50000.smf");
    if (!mesh) return;
    const PatchSet set = cluster_mesh(*mesh, {});
    CHECK(set.stats.surfel_patches >= 100);
    double floor = 0, total = 0;
    for (const ClusterPatch& p : set.patches) {
        total += static_cast<double>(p.area);
        if (p.representation == format::Representation::kTriangles) floor += static_cast<double>(p.area);
    }
    CHECK(floor / total > 0.7);
}
