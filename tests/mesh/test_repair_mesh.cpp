#include "preprocess/mesh/shapes.h"
#include "tests/mesh/mesh_checks.h"

#include <limits>
#include <random>

using namespace splice;
using namespace splice::test;

namespace {

SourceMesh source(std::vector<Vec3d> positions, const std::vector<Indices>& faces) {
    SourceMesh mesh;
    mesh.positions = std::move(positions);
    mesh.polygon_begin.push_back(0);
    for (const Indices& face : faces) {
        mesh.corner_position.insert(mesh.corner_position.end(), face.begin(), face.end());
        mesh.polygon_begin.push_back(mesh.corner_position.size());
    }
    return mesh;
}

const std::vector<Vec3d> kTetrahedron = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
const std::vector<Indices> kTetrahedronFaces = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};

/// Turns every polygon for which `choose` says so, corner attributes not included.
template <class Choose>
void turn(SourceMesh& mesh, Choose choose) {
    for (std::size_t p = 0; p + 1 < mesh.polygon_begin.size(); ++p) {
        if (!choose(p)) continue;
        std::reverse(mesh.corner_position.begin() + static_cast<std::ptrdiff_t>(mesh.polygon_begin[p]),
                     mesh.corner_position.begin() + static_cast<std::ptrdiff_t>(mesh.polygon_begin[p + 1]));
    }
}

}  // namespace

TEST_CASE("A clean closed mesh passes unchanged but for the unit box") {
    RepairReport report;
    const IndexedMesh mesh = repaired(source(kTetrahedron, kTetrahedronFaces), &report);
    check_invariants(mesh);
    CHECK(mesh.triangles == std::vector<Triangle>{{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}});
    CHECK(mesh.closed);
    CHECK(mesh.consistently_oriented);
    CHECK(report.source_vertices == 4);
    CHECK(report.source_polygons == 4);
    CHECK(report.source_triangles == 4);
    CHECK(report.welded_vertices + report.isolated_vertices + report.nonfinite_vertices + report.invalid_polygons +
              report.degenerate_triangles + report.duplicate_triangles + report.flipped_triangles +
              report.boundary_edges + report.nonmanifold_edges ==
          0);
    CHECK(report.computed_normals == 12);
}

TEST_CASE("The unit box: longest side 1, centred, and the way back is kept") {
    const IndexedMesh mesh =
        repaired(source({{636000, 848900, 400}, {636010, 848900, 400}, {636010, 848904, 401}}, {{0, 1, 2}}));
    check_invariants(mesh);
    CHECK(mesh.source_scale == 10);
    CHECK(mesh.source_offset == Vec3d(636005, 848902, 400.5));
    CHECK(mesh.positions[2] == Vec3f(0.5f, 0.2f, 0.05f));
}

TEST_CASE("Isolated vertices and vertices of dropped faces do not widen the box") {
    RepairReport report;
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const IndexedMesh mesh = repaired(
        source({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1000, 0, 0}, {-500, 0, 0}, {-600, 0, 0}, {-700, 0, 0}, {nan, 0, 0}},
               {{0, 1, 2}, {4, 5, 6}, {0, 1, 7}}),
        &report);
    check_invariants(mesh);
    CHECK(mesh.source_scale == 1);
    CHECK(report.isolated_vertices == 1);
    CHECK(report.nonfinite_vertices == 1);
    CHECK(report.invalid_polygons == 1);
    CHECK(report.degenerate_triangles == 1);
    CHECK(mesh.positions.size() == 3);
}

TEST_CASE("Points that only a far degenerate face makes equal are told apart once it is gone") {
    RepairReport report;
    const IndexedMesh mesh =
        repaired(source({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1e20, 0, 0}, {2e20, 0, 0}, {3e20, 0, 0}, {1, 1, 0}},
                        {{0, 1, 2}, {3, 4, 5}, {1, 6, 2}}),
                 &report);
    // In the first box the small faces collapse into a point; they go with the line that made it so large.
    CHECK(mesh.triangles.size() == 2);
    CHECK(mesh.source_scale == 1);
    CHECK(report.degenerate_triangles == 1);
}

TEST_CASE("Triangles without area leave no slit where they bridge two sides of different subdivision") {
    // Below the line y = 0 one triangle, above it three; two caps on the line join them.
    RepairReport report;
    const IndexedMesh mesh = repaired(source({{0, 0, 0}, {3, 0, 0}, {1, 0, 0}, {2, 0, 0}, {1.5, 2, 0}, {1.5, -2, 0}},
                                             {{0, 5, 1}, {0, 1, 2}, {2, 1, 3}, {0, 2, 4}, {2, 3, 4}, {3, 1, 4}}),
                                      &report);
    check_invariants(mesh);
    CHECK(mesh.triangles.size() == 6);
    CHECK(report.flipped_caps == 2);
    CHECK(report.degenerate_triangles == 0);
    CHECK(report.boundary_edges == 4);
    CHECK(mesh.consistently_oriented);
    CHECK(area(mesh) == Approx(6.0 / 16));
}

TEST_CASE("A cap on the border of a mesh is just dropped") {
    RepairReport report;
    const IndexedMesh mesh =
        repaired(source({{0, 0, 0}, {2, 0, 0}, {1, 0, 0}, {1, 1, 0}}, {{0, 2, 3}, {2, 1, 3}, {0, 1, 2}}), &report);
    check_invariants(mesh);
    CHECK(mesh.triangles.size() == 2);
    CHECK(report.degenerate_triangles == 1);
    CHECK(report.boundary_edges == 4);
}

TEST_CASE("Equal positions are welded, minus zero included") {
    RepairReport report;
    const IndexedMesh mesh = repaired(
        source({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {-0.0, 1, 0}, {1, 0, 0}, {1, 1, 0}}, {{0, 1, 2}, {4, 5, 3}}), &report);
    check_invariants(mesh);
    CHECK(report.welded_vertices == 2);
    CHECK(mesh.positions.size() == 4);
    CHECK(report.boundary_edges == 4);
    CHECK(mesh.triangles[1] == Triangle{1, 3, 2});
}

TEST_CASE("Huge and tiny coordinates survive, not-a-number and infinity do not") {
    for (const double size : {1e30, 1e90, 1e-30, 1e-300}) {
        SourceMesh huge = source(kTetrahedron, kTetrahedronFaces);
        for (Vec3d& p : huge.positions)
            p *= size;
        const IndexedMesh mesh = repaired(std::move(huge));
        check_invariants(mesh);
        CHECK(mesh.closed);
        CHECK(mesh.source_scale == Approx(size));
    }
    for (const double bad :
         {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(), 1e200}) {
        SourceMesh broken = source(kTetrahedron, kTetrahedronFaces);
        broken.positions[3].y() = bad;
        RepairReport report;
        CHECK(repaired(std::move(broken), &report).triangles.size() == 1);
        CHECK(report.nonfinite_vertices == 1);
        CHECK(report.invalid_polygons == 3);
    }
}

TEST_CASE("Invalid, degenerate and duplicate faces are dropped and counted, the first of equals stays") {
    RepairReport report;
    const IndexedMesh mesh = repaired(
        source({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0.5, 0, 0}},
               {{0, 1, 2}, {}, {0}, {0, 1}, {0, 1, 99}, {0, 0, 1}, {0, 3, 1}, {1, 2, 0}, {2, 1, 0}, {1, 1, 1}}),
        &report);
    check_invariants(mesh);
    CHECK(mesh.triangles.size() == 1);
    CHECK(report.invalid_polygons == 4);
    CHECK(report.degenerate_triangles == 3);
    CHECK(report.duplicate_triangles == 2);
}

TEST_CASE("A tetrahedron with every face twice, some flipped, is a closed tetrahedron") {
    RepairReport report;
    auto faces = kTetrahedronFaces;
    faces.insert(faces.end(), {{0, 1, 2}, {0, 1, 3}, {0, 2, 3}, {1, 3, 2}});
    const IndexedMesh mesh = repaired(source(kTetrahedron, faces), &report);
    CHECK(report.duplicate_triangles == 4);
    CHECK(mesh.closed);
    CHECK(mesh.consistently_oriented);
    CHECK(signed_volume(mesh) > 0);
}

TEST_CASE("Randomly turned faces of a closed mesh come out facing outwards") {
    std::mt19937 random(3);
    SourceMesh shuffled = shapes::ico_sphere(6);
    turn(shuffled, [&](std::size_t) { return random() % 3 != 0; });
    RepairReport report;
    const IndexedMesh mesh = repaired(std::move(shuffled), &report);
    CHECK(report.flipped_triangles > 0);
    CHECK(mesh.consistently_oriented);
    CHECK(signed_volume(mesh) > 0);
}

TEST_CASE("A closed mesh that is inside out is turned, and its normals with it") {
    const SourceMesh sphere = shapes::ico_sphere(3);
    const IndexedMesh wanted = repaired(sphere);
    for (const bool normals_turned : {false, true}) {
        SourceMesh inside_out = sphere;
        turn(inside_out, [](std::size_t) { return true; });
        for (const std::uint32_t v : inside_out.corner_position) {
            const Vec3f outwards = inside_out.positions[v].normalized().cast<float>();
            inside_out.corner_normals.push_back(normals_turned ? Vec3f(-outwards) : outwards);
        }
        RepairReport report;
        const IndexedMesh mesh = repaired(std::move(inside_out), &report);
        CHECK(report.flipped_triangles == 0);
        CHECK(report.inverted_triangles == mesh.triangles.size());
        CHECK(report.computed_normals == 0);
        CHECK(mesh.consistently_oriented);
        CHECK(signed_volume(mesh) == Approx(signed_volume(wanted)));
        for (std::size_t c = 0; c < mesh.corner_normals.size(); ++c) {
            const Vec3f& p = mesh.positions[mesh.triangles[c / 3][c % 3]];
            CHECK(mesh.corner_normals[c].dot(p.normalized()) > 0.99f);
        }
    }
}

TEST_CASE("A hollow body is not inside out, whatever its cavity") {
    SourceMesh hollow = shapes::ico_sphere(3), cavity = shapes::ico_sphere(2);
    turn(cavity, [](std::size_t) { return true; });
    const auto first = static_cast<std::uint32_t>(hollow.positions.size());
    for (const auto& p : cavity.positions)
        hollow.positions.push_back(0.5 * p);
    for (const std::uint32_t v : cavity.corner_position)
        hollow.corner_position.push_back(first + v);
    const std::uint64_t corners = hollow.polygon_begin.back();
    for (std::size_t i = 1; i < cavity.polygon_begin.size(); ++i)
        hollow.polygon_begin.push_back(corners + cavity.polygon_begin[i]);
    RepairReport report;
    repaired(std::move(hollow), &report);
    CHECK(report.inverted_triangles == 0);
    CHECK(report.flipped_triangles == 0);
}

TEST_CASE("In an open mesh the minority is turned, with its corner attributes") {
    SourceMesh plane = shapes::checkerboard(2, 4);
    turn(plane, [](std::size_t p) { return p == 3; });
    // The attributes of polygon 3 turn with its corners.
    std::reverse(plane.corner_uvs.begin() + 12, plane.corner_uvs.begin() + 16);
    RepairReport report;
    const IndexedMesh mesh = repaired(std::move(plane), &report);
    CHECK(report.flipped_triangles == 2);
    CHECK(mesh.consistently_oriented);
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        for (std::size_t k = 0; k < 3; ++k) {
            const Vec3f& p = mesh.positions[mesh.triangles[t][k]];
            CHECK((mesh.corner_uvs[3 * t + k] - Vec2f(p.x() + 0.5f, 0.5f - p.y())).norm() < 1e-6f);
            CHECK(mesh.corner_normals[3 * t + k].z() == Approx(1));
        }
    }
}

TEST_CASE("A Moebius strip is not orientable and is left alone") {
    constexpr std::uint32_t n = 30;
    SourceMesh strip;
    strip.polygon_begin.push_back(0);
    for (std::uint32_t i = 0; i < n; ++i) {
        const double turn_angle = 2 * 3.14159265358979 * i / n;
        for (const double side : {-0.3, 0.3}) {
            const double r = 1 + side * std::cos(turn_angle / 2);
            strip.positions.emplace_back(r * std::cos(turn_angle), r * std::sin(turn_angle),
                                         side * std::sin(turn_angle / 2));
        }
    }
    for (std::uint32_t i = 0; i < n; ++i) {
        const std::uint32_t a = 2 * i, b = a + 1;
        const std::uint32_t c = i + 1 < n ? a + 2 : 1, d = i + 1 < n ? a + 3 : 0;
        for (const std::uint32_t v : {a, c, d, b})
            strip.corner_position.push_back(v);
        strip.polygon_begin.push_back(strip.corner_position.size());
    }
    RepairReport report;
    const IndexedMesh mesh = repaired(std::move(strip), &report);
    check_invariants(mesh);
    CHECK(report.flipped_triangles == 0);
    CHECK_FALSE(mesh.consistently_oriented);
    CHECK_FALSE(mesh.closed);
    CHECK(report.boundary_edges == 2 * n);
}

TEST_CASE("Edges of four faces are counted and the mesh is neither closed nor one-sided") {
    RepairReport report;
    const IndexedMesh mesh = repaired(source({{0, 0, 0}, {0, 0, 1}, {1, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {0, -1, 0}},
                                             {{0, 1, 2}, {0, 1, 3}, {0, 1, 4}, {0, 1, 5}}),
                                      &report);
    check_invariants(mesh);
    CHECK(report.nonmanifold_edges == 1);
    CHECK(report.boundary_edges == 8);
    CHECK_FALSE(mesh.closed);
    CHECK_FALSE(mesh.consistently_oriented);
}

TEST_CASE("Nothing left is an error that says why") {
    CHECK_THAT(input_error([] {
                   repaired(source({{0, 0, 0}, {1, 1, 1}, {2, 2, 2}}, {{0, 1, 2}}));
               }),
               Catch::Contains("no usable triangle"));
    CHECK_THAT(input_error([] {
                   repaired(source({{1, 1, 1}, {1, 1, 1}, {1, 1, 1}}, {{0, 1, 2}}));
               }),
               Catch::Contains("no usable triangle"));
    CHECK_THAT(input_error([] { repaired(source({{0, 0, 0}}, {{0, 5, 7}})); }), Catch::Contains("1 invalid"));
    CHECK_THAT(input_error([] { repaired(source({{0, 0, 0}}, {})); }), Catch::Contains("no faces"));
}

TEST_CASE("Materials and attributes follow their triangles, bad ones are made harmless") {
    SourceMesh mesh =
        source({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {2, 0, 0}}, {{0, 1, 2, 3}, {0, 0, 1}, {1, 4, 2}});
    mesh.materials.resize(2);
    mesh.polygon_material = {1, 0, 77};
    const float nan = std::numeric_limits<float>::quiet_NaN();
    mesh.corner_uvs = {{0, 0}, {1, 0}, {1, 1}, {0, 1}, {9, 9}, {9, 9}, {9, 9}, {1, 0}, {nan, 0}, {1, 1}};
    mesh.corner_colours = {1, 2, 3, 4, 9, 9, 9, 5, 6, 7};
    const IndexedMesh result = repaired(std::move(mesh));
    check_invariants(result);
    CHECK(result.triangle_material == std::vector<std::uint32_t>{1, 1, 0});
    CHECK(result.has_colours);
    for (const Vec2f& uv : result.corner_uvs)
        CHECK(uv.maxCoeff() <= 1);
    CHECK(std::vector<std::uint32_t>(result.corner_colours.begin() + 6, result.corner_colours.end()) ==
          std::vector<std::uint32_t>{5, 6, 7});
}

TEST_CASE("Repair gives the same bytes every time") {
    const IndexedMesh a = repaired(shapes::terrain(60)), b = repaired(shapes::terrain(60));
    CHECK(a.positions == b.positions);
    CHECK(a.triangles == b.triangles);
    CHECK(a.corner_normals == b.corner_normals);
}
