// A point cloud on its way to a model file.
#include "preprocess/build_model/build_model.h"
#include "preprocess/model_format/error.h"
#include "preprocess/model_format/half.h"
#include "preprocess/model_format/point_node.h"
#include "tests/cloud/cloud_shapes.h"
#include "tests/support/test_files.h"

#include <catch2/catch.hpp>

#include <fstream>
#include <set>

using namespace splice;
using namespace splice::test;

namespace {

PointCloud cloud_of(std::vector<Vec3f> points) {
    PointCloud cloud;
    cloud.source_points = points.size();
    cloud.offsets = std::move(points);
    return cloud;
}

Model bake(PointCloud cloud, int threads = 0) {
    BakeStats stats;
    BakeOptions options;
    options.threads = threads;
    return build_cloud_model(std::move(cloud), options, stats);
}

}  // namespace

TEST_CASE("a cloud's model is one that the reader accepts, with a surfel for each point") {
    for (const std::size_t points : {1u, 2u, 15u, 5000u}) {
        INFO(points << " points");
        const Model model = bake(cloud_of(sphere_points(points, 1)));
        const std::vector<std::byte> bytes = serialise_model(view_of(model));
        const ModelView view = parse_model(bytes, "cloud");
        CHECK(view.surfels.empty());
        CHECK(view.packed_surfels.size() == points);
        CHECK(view.info->source_vertices == points);
        CHECK((view.info->flags & format::kPointCloud) != 0);
        CHECK((view.info->flags & format::kTwoSided) != 0);
        CHECK(unpack_point_tree(view.point_tree).front().surfel_count == points);
        std::uint64_t in_patches = 0;
        for (const format::Patch& patch : view.patches) {
            CHECK(patch.surfel_count <= 1024);
            in_patches += patch.surfel_count;
        }
        CHECK(in_patches == points);
    }
}

TEST_CASE("survey coordinates come back from a model file to the millimetre") {
    PointCloud cloud = cloud_of({});
    cloud.origin = {512345.678, 5403059.123, 247.5};
    std::multiset<double> eastings;
    for (int i = 0; i < 4000; ++i) {
        const Vec3d offset(0.25 * (i % 63), 0.371 * (i / 63), 0.013 * (i % 17));
        cloud.offsets.push_back(offset.cast<float>());
        eastings.insert(cloud.origin.x() + offset.x());
    }
    const Model model = bake(std::move(cloud));
    std::multiset<double> found;
    const ModelView view = view_of(model);
    for (std::uint64_t i = 0; i < view.surfel_count(); ++i)
        found.insert(static_cast<double>(view.surfel(i).position[0]) * model.info.source_scale +
                     model.info.source_offset[0]);
    REQUIRE(found.size() == eastings.size());
    double worst = 0;
    for (auto a = eastings.begin(), b = found.begin(); a != eastings.end(); ++a, ++b)
        worst = std::max(worst, std::abs(*a - *b));
    CHECK(worst < 1e-4);
}

TEST_CASE("colours of a cloud reach its surfels") {
    PointCloud cloud = cloud_of(sphere_points(100, 2));
    cloud.colours.assign(100, 0xff302010u);
    const Model model = bake(std::move(cloud));
    CHECK((model.info.flags & format::kHasColours) != 0);
    const ModelView view = view_of(model);
    REQUIRE(view.surfel_count() == 100);
    for (std::uint64_t i = 0; i < 100; ++i) {
        const format::Surfel surfel = view.surfel(i);
        CHECK((surfel.colour[0] == 0x10 && surfel.colour[1] == 0x20 && surfel.colour[2] == 0x30));
    }
}

TEST_CASE("a cloud's model is the same bytes for any number of threads") {
    CHECK(serialise_model(view_of(bake(cloud_of(torus_points(20000, 3)), 1))) ==
          serialise_model(view_of(bake(cloud_of(torus_points(20000, 3)), 4))));
}

TEST_CASE("bake_file tells clouds from meshes and counts what it dropped") {
    const TemporaryFolder folder;
    std::ofstream(folder / "scan.xyz") << "0 0 0\n1 0 0\n0 1 0\n1 1 0\nnan 0 0\n1 1 0\n";
    BakeStats stats;
    const Model model = bake_file(folder / "scan.xyz", {}, stats);
    REQUIRE(stats.cloud);
    CHECK(stats.cloud->source_points == 6);
    CHECK(stats.cloud->nonfinite_points == 1);
    CHECK(stats.cloud->duplicate_points == 1);
    CHECK(stats.cloud->points == 4);
    CHECK(stats.cloud->estimated_normals == 4);
    CHECK(model.packed_surfels.size() == 4);

    std::ofstream(folder / "mesh.ply")
        << "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
           "property float z\nelement face 1\nproperty list uchar int vertex_indices\n"
           "end_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
    BakeStats of_mesh;
    CHECK(bake_file(folder / "mesh.ply", {}, of_mesh).info.source_triangles == 1);
    CHECK_FALSE(of_mesh.cloud);
}

TEST_CASE("a cloud cannot be baked as triangles") {
    BakeOptions options;
    options.cluster.representation = ForcedRepresentation::kTriangles;
    BakeStats stats;
    CHECK_THROWS_AS(build_cloud_model(cloud_of(sphere_points(10, 1)), options, stats), UsageError);
}

TEST_CASE("a damaged cloud model is refused") {
    const Model good = bake(cloud_of(sphere_points(2000, 4)));
    const auto refuses = [&](const auto& damage) {
        Model model = good;
        damage(model);
        const std::vector<std::byte> bytes = serialise_model(view_of(model));
        CHECK_THROWS_AS(parse_model(bytes, "cloud"), InputError);
    };
    refuses([](Model& m) { m.info.flags &= ~format::kPointCloud; });
    refuses([](Model& m) { m.point_tree[0].below -= 1; });
    refuses([](Model& m) { m.point_tree[0].below = 128 + 9; });
    refuses([](Model& m) { m.point_tree[0].below = 128; });
    refuses([](Model& m) { m.point_tree.back().below = 0; });
    refuses([](Model& m) { m.point_tree.back().below += 1; });
    refuses([](Model& m) { m.point_tree.back().below = 128 + 1; });
    refuses([](Model& m) { m.point_tree[1].place[1] |= 1u << 28; });
    refuses([](Model& m) { m.point_tree[0].major |= 0x8000; });
    refuses([](Model& m) { m.point_tree[3].sphere_radius = 0x7c00; });
    refuses([](Model& m) { m.point_tree[3].major = 0x7e00; });
    refuses([](Model& m) { m.point_tree.pop_back(); });
    refuses([](Model& m) { m.patches[0].merge_root = 1; });
    refuses([](Model& m) { m.packed_surfels.pop_back(); });
    refuses([](Model& m) { m.packed_surfels.push_back(m.packed_surfels[0]); });
    refuses([](Model& m) { m.packed_surfels.clear(); });
    refuses([](Model& m) { m.packed_surfels[5].shape |= 0x3ffu << 20; });  // radius
    refuses([](Model& m) { m.patches[0].max_surfel_epsilon /= 4; });
    refuses([](Model& m) { m.surfels.push_back(view_of(m).surfel(0)); });
}
