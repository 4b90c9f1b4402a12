#include "preprocess/build_model/build_model.h"
#include "preprocess/build_model/normal_cone.h"
#include "preprocess/mesh/shapes.h"
#include "preprocess/model_format/error.h"
#include "preprocess/model_format/half.h"
#include "preprocess/model_format/octahedral.h"
#include "preprocess/model_format/point_node.h"
#include "tests/support/test_files.h"

#include <catch2/catch.hpp>

#include <Eigen/Geometry>
#include <algorithm>
#include <fstream>
#include <numeric>
#include <set>

using namespace splice;

namespace {

IndexedMesh repaired(SourceMesh source) {
    RepairReport report;
    return repair_mesh(std::move(source), {}, report, "test");
}

Model build(const IndexedMesh& mesh, const BakeOptions& options = {}) {
    BakeStats stats;
    return build_model(mesh, options, stats);
}

// Half surfels, half triangles.
BakeOptions mixed() {
    BakeOptions options;
    options.cluster.triangle_share = 0.5;
    return options;
}

Vec3f vec(const float (&v)[3]) {
    return {v[0], v[1], v[2]};
}

std::span<const std::uint32_t> indices_of(const Model& model, const format::Lod& lod) {
    return std::span(model.indices).subspan(lod.first_index, lod.index_count);
}

void check_parses(const Model& model) {
    const std::vector<std::byte> bytes = serialise_model(view_of(model));
    CHECK_NOTHROW(parse_model(bytes, "built"));
}

// A triangle as a set of corners, whatever corner comes first.
using Corners = std::array<std::array<float, 3>, 3>;
Corners corners(const Vec3f& a, const Vec3f& b, const Vec3f& c) {
    Corners result = {{{a.x(), a.y(), a.z()}, {b.x(), b.y(), b.z()}, {c.x(), c.y(), c.z()}}};
    std::ranges::rotate(result, std::ranges::min_element(result));
    return result;
}

std::vector<std::uint32_t> leaves_under(const Model& model, std::uint32_t node) {
    std::vector<std::uint32_t> leaves, stack = {node};
    const auto triangles = static_cast<std::uint32_t>(model.info.source_triangles);
    while (!stack.empty()) {
        const std::uint32_t at = stack.back();
        stack.pop_back();
        if (at < triangles)
            leaves.push_back(at);
        else
            for (const std::uint32_t child : model.merge_tree[at - triangles].child)
                stack.push_back(child);
    }
    std::ranges::sort(leaves);
    return leaves;
}

}  // namespace

TEST_CASE("built models satisfy the reader") {
    check_parses(build(repaired(shapes::cube())));
    check_parses(build(repaired(shapes::bumpy_sphere(3000))));
    check_parses(build(repaired(shapes::bumpy_sphere(3000)), mixed()));
    check_parses(build(repaired(shapes::machined_part(32)), mixed()));
    check_parses(build(repaired(shapes::terrain(30)), mixed()));
    check_parses(build(repaired(shapes::checkerboard(4, 8)), mixed()));
}

TEST_CASE("a model holds the mesh's triangles, each once") {
    const IndexedMesh mesh = repaired(shapes::bumpy_sphere(3000));
    const Model model = build(mesh, mixed());
    std::multiset<Corners> expected, found;
    for (const Triangle& t : mesh.triangles)
        expected.insert(corners(mesh.positions[t[0]], mesh.positions[t[1]], mesh.positions[t[2]]));
    for (std::size_t i = 0; i < 3 * mesh.triangles.size(); i += 3)
        found.insert(corners(vec(model.vertices[model.indices[i]].position),
                             vec(model.vertices[model.indices[i + 1]].position),
                             vec(model.vertices[model.indices[i + 2]].position)));
    CHECK(expected == found);
}

TEST_CASE("a patch's merge root stands for exactly its triangles") {
    const Model model = build(repaired(shapes::bumpy_sphere(3000)), mixed());
    CHECK(model.patches.size() > 10);
    for (const format::Patch& patch : model.patches) {
        const format::Lod& finest = model.lods[patch.first_lod];
        std::vector<std::uint32_t> own(finest.index_count / 3);
        std::iota(own.begin(), own.end(), static_cast<std::uint32_t>(finest.first_index / 3));
        CHECK(leaves_under(model, patch.merge_root) == own);
    }
}

TEST_CASE("patch bounds hold triangles and disks") {
    const Model model = build(repaired(shapes::bumpy_sphere(3000)), mixed());
    CHECK(!model.surfels.empty());
    for (const format::Patch& patch : model.patches) {
        const Vec3f low = vec(patch.bounds_min), high = vec(patch.bounds_max);
        for (std::uint32_t level = 0; level < patch.lod_count; ++level) {
            for (const std::uint32_t index : indices_of(model, model.lods[patch.first_lod + level])) {
                const Vec3f p = vec(model.vertices[index].position);
                CHECK((p.array() >= low.array()).all());
                CHECK((p.array() <= high.array()).all());
            }
        }
        for (std::uint64_t i = 0; i < patch.surfel_count; ++i) {
            const format::Surfel& surfel = model.surfels[patch.first_surfel + i];
            const auto n = decode_octahedral(surfel.normal);
            const Vec3f normal(n[0], n[1], n[2]);
            const Vec3f s = normal.unitOrthogonal(), t = normal.cross(s);
            for (int k = 0; k < 16; ++k) {
                const float angle = static_cast<float>(k) * 0.3926991f;
                const Vec3f p =
                    vec(surfel.position) + float_from_half(surfel.radius) * (std::cos(angle) * s + std::sin(angle) * t);
                CHECK((p.array() >= low.array() - 1e-6f).all());
                CHECK((p.array() <= high.array() + 1e-6f).all());
            }
        }
    }
}

TEST_CASE("normal cones hold shading and face normals") {
    const Model model = build(repaired(shapes::machined_part(32)), mixed());
    std::size_t narrow = 0;
    for (const format::Patch& patch : model.patches) {
        const Vec3f axis = vec(patch.cone_axis);
        narrow += patch.cone_cos > 0;
        for (std::uint32_t level = 0; level < patch.lod_count; ++level) {
            const auto indices = indices_of(model, model.lods[patch.first_lod + level]);
            for (std::size_t i = 0; i < indices.size(); i += 3) {
                Vec3f p[3];
                for (std::size_t k = 0; k < 3; ++k) {
                    p[k] = vec(model.vertices[indices[i + k]].position);
                    const auto n = decode_octahedral(model.vertices[indices[i + k]].normal);
                    CHECK(Vec3f(n[0], n[1], n[2]).dot(axis) >= patch.cone_cos);
                }
                const Vec3f face =
                    (p[1] - p[0]).cast<double>().cross((p[2] - p[0]).cast<double>()).normalized().cast<float>();
                CHECK(face.dot(axis) >= patch.cone_cos);
            }
        }
        for (std::uint64_t i = 0; i < patch.surfel_count; ++i) {
            const auto n = decode_octahedral(model.surfels[patch.first_surfel + i].normal);
            CHECK(Vec3f(n[0], n[1], n[2]).dot(axis) >= patch.cone_cos);
        }
    }
    CHECK(narrow > 0);
}

TEST_CASE("each patch with surfels is a node of the point tree") {
    const Model model = build(repaired(shapes::bumpy_sphere(20000)), mixed());
    std::set<std::pair<std::uint64_t, std::uint32_t>> ranges;
    const std::vector<format::PointNode> tree = unpack_point_tree(model.point_tree);
    for (const format::PointNode& node : tree) {
        ranges.insert({node.first_surfel, node.surfel_count});
        CHECK(node.child_count != 1);
    }
    std::size_t patches = 0;
    for (const format::Patch& patch : model.patches) {
        if (patch.surfel_count == 0) continue;
        ++patches;
        CHECK(ranges.count({patch.first_surfel, patch.surfel_count}) == 1);
    }
    CHECK(patches > 8);
    CHECK(tree.front().surfel_count == model.surfels.size());
}

TEST_CASE("normals that point everywhere make an open cone") {
    const std::vector<Vec3f> normals = {Vec3f::UnitX(), -Vec3f::UnitX()};
    const NormalCone cone = enclose_normals(normals);
    CHECK(cone.cosine == -1.0f);
    CHECK(cone.axis.norm() == Approx(1));
}

TEST_CASE("open and inconsistent surfaces are two-sided, closed ones are not") {
    CHECK((build(repaired(shapes::bumpy_sphere(500))).info.flags & format::kTwoSided) == 0);
    CHECK((build(repaired(shapes::terrain(8))).info.flags & format::kTwoSided) != 0);
}

TEST_CASE("a textured mesh keeps its image, with mips") {
    const IndexedMesh mesh = repaired(shapes::checkerboard(4, 8));
    REQUIRE(mesh.images.size() == 1);
    const Model model = build(mesh);
    REQUIRE(model.textures.size() == 1);
    CHECK(model.textures[0].width == mesh.images[0].width);
    CHECK(std::ranges::equal(std::span(model.texels).first(mesh.images[0].rgba.size()),
                             std::as_bytes(std::span(mesh.images[0].rgba))));
    CHECK((model.info.flags & format::kHasUvs) != 0);
    const format::Material& material = model.materials[model.patches[0].material];
    CHECK(material.texture == 0);
}

TEST_CASE("images that no material uses are left out") {
    IndexedMesh mesh = repaired(shapes::checkerboard(4, 2));
    mesh.images.insert(mesh.images.begin(), Image{1, 1, {1, 2, 3, 4}});
    for (MeshMaterial& material : mesh.materials)
        if (material.image != kNoImage) ++material.image;
    const Model model = build(mesh);
    REQUIRE(model.textures.size() == 1);
    CHECK(model.textures[0].width == mesh.images[1].width);
}

TEST_CASE("the way back to the source's coordinates is stored") {
    SourceMesh source = shapes::cube();
    for (Vec3d& position : source.positions)
        position = position * 40 + Vec3d(100, 200, 300);
    const Model model = build(repaired(std::move(source)));
    Vec3d low = Vec3d::Constant(1e9), high = Vec3d::Constant(-1e9);
    for (const format::Vertex& vertex : model.vertices) {
        const Vec3d back = vec(vertex.position).cast<double>() * model.info.source_scale +
                           Vec3d(model.info.source_offset[0], model.info.source_offset[1], model.info.source_offset[2]);
        low = low.cwiseMin(back);
        high = high.cwiseMax(back);
    }
    CHECK((low - Vec3d(80, 180, 280)).norm() < 1e-4);
    CHECK((high - Vec3d(120, 220, 320)).norm() < 1e-4);
}

TEST_CASE("a model does not depend on the number of threads") {
    const IndexedMesh mesh = repaired(shapes::bumpy_sphere(4000));
    BakeOptions one = mixed(), three = mixed();
    one.threads = 1;
    three.threads = 3;
    CHECK(serialise_model(view_of(build(mesh, one))) == serialise_model(view_of(build(mesh, three))));
}

TEST_CASE("bake_file reports what it read and did") {
    const test::TemporaryFolder folder;
    std::ofstream(folder / "quad.obj") << "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 7 7 7\nmtllib absent.mtl\nf 1 2 3 4\n";
    BakeStats stats;
    std::vector<std::string> stages;
    const Model model = bake_file(folder / "quad.obj", {}, stats, [&](std::string_view stage, double fraction) {
        CHECK(fraction >= 0);
        CHECK(fraction <= 1);
        if (stages.empty() || stages.back() != stage) stages.emplace_back(stage);
    });
    check_parses(model);
    CHECK(stats.repair.source_vertices == 5);
    CHECK(stats.repair.isolated_vertices == 1);
    CHECK(stats.vertices == 4);
    CHECK(stats.triangles == 2);
    CHECK(stats.repair.boundary_edges == 4);
    CHECK(stats.warnings.size() == 1);
    CHECK(stages.front() == "read");
    CHECK(std::set<std::string>(stages.begin(), stages.end()).size() == stages.size());  // no stage comes twice
    CHECK_THROWS_AS(bake_file(folder / "absent.obj", {}, stats), Error);
}
