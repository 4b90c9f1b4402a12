#include "preprocess/mesh/shapes.h"
#include "tests/mesh/mesh_checks.h"

#include <cmath>
#include <numbers>

using namespace splice;
using namespace splice::test;

namespace {

/// Closed, manifold, outwards, nothing to repair.
IndexedMesh check_closed(SourceMesh source, int genus) {
    RepairReport report;
    const IndexedMesh mesh = repaired(std::move(source), &report);
    check_invariants(mesh);
    CHECK(mesh.closed);
    CHECK(mesh.consistently_oriented);
    CHECK(signed_volume(mesh) > 0);
    CHECK(report.flipped_triangles + report.degenerate_triangles + report.duplicate_triangles +
              report.isolated_vertices + report.welded_vertices + report.invalid_polygons ==
          0);
    // Euler: V - E + F = 2 - 2g, and 2E = 3F.
    const auto v = static_cast<int>(mesh.positions.size()), f = static_cast<int>(mesh.triangles.size());
    CHECK(v - f / 2 == 2 - 2 * genus);
    return mesh;
}

}  // namespace

TEST_CASE("Closed shapes are closed, face outwards and need no repair") {
    CHECK(check_closed(shapes::cube(1), 0).triangles.size() == 12);
    CHECK(check_closed(shapes::cube(4), 0).triangles.size() == 192);
    CHECK(check_closed(shapes::uv_sphere(12, 7), 0).corner_uvs.size() == 3 * 2 * 12 * 6);
    CHECK(check_closed(shapes::ico_sphere(1), 0).triangles.size() == 20);
    CHECK(check_closed(shapes::ico_sphere(5), 0).triangles.size() == 500);
    CHECK(check_closed(shapes::torus_knot(2, 3, 200, 16), 1).has_colours);
    check_closed(shapes::machined_part(32), 1);
    CHECK(check_closed(shapes::bumpy_sphere(2000), 0).triangles.size() == 2000);
}

TEST_CASE("Arguments that are too small are raised") {
    check_closed(shapes::cube(0), 0);
    check_closed(shapes::uv_sphere(0, 0), 0);
    check_closed(shapes::ico_sphere(0), 0);
    check_closed(shapes::machined_part(0), 1);
    check_closed(shapes::torus_knot(1, 1, 0, 0), 1);
    CHECK(polygons(shapes::terrain(0)) == 2);
    CHECK(polygons(shapes::checkerboard(0, 0)) == 1);
}

TEST_CASE("Sphere and cube have the volume they should") {
    const IndexedMesh sphere = repaired(shapes::ico_sphere(30));
    CHECK(signed_volume(sphere) == Approx(std::numbers::pi / 6).epsilon(0.005));
    CHECK(signed_volume(repaired(shapes::cube(3))) == Approx(1).epsilon(1e-6));
}

TEST_CASE("The bumpy sphere's analytic normals agree with its surface") {
    const double h = 1e-6;
    for (int i = 0; i < 200; ++i) {
        const double z = 1 - 2 * (i + 0.5) / 200, azimuth = i * 2.399963;
        const double ring = std::sqrt(1 - z * z);
        const Vec3d d(ring * std::cos(azimuth), ring * std::sin(azimuth), z);
        const Vec3d a = d.unitOrthogonal(), b = d.cross(a);
        const auto surface = [](const Vec3d& direction) {
            return (shapes::bumpy_radius(direction) * direction).eval();
        };
        const Vec3d along_a = surface((d + h * a).normalized()) - surface((d - h * a).normalized());
        const Vec3d along_b = surface((d + h * b).normalized()) - surface((d - h * b).normalized());
        CHECK((along_a.cross(along_b).normalized() - shapes::bumpy_normal(d)).norm() < 1e-6);
    }
    const IndexedMesh mesh = repaired(shapes::bumpy_sphere(5000));
    CHECK(mesh.corner_colours[0] == 0xffff8900u);
}

TEST_CASE("The terrain is one sheet that faces up, different for each seed") {
    RepairReport report;
    const IndexedMesh mesh = repaired(shapes::terrain(50), &report);
    CHECK(mesh.triangles.size() == 5000);
    CHECK(report.boundary_edges == 200);
    CHECK(report.nonmanifold_edges == 0);
    CHECK(mesh.has_colours);
    for (const Vec3f& n : mesh.corner_normals)
        CHECK(n.z() > 0);
    CHECK(repaired(shapes::terrain(50, 2)).positions != mesh.positions);
}

TEST_CASE("The checkerboard's image repeats with its tiles") {
    const SourceMesh mesh = shapes::checkerboard(8);
    REQUIRE(mesh.images.size() == 1);
    const Image& image = mesh.images[0];
    CHECK(image.width == 128);
    CHECK(image.rgba.size() == std::size_t{4} * image.width * image.height);
    const auto texel = [&](std::size_t x, std::size_t y) { return image.rgba[4 * (y * image.width + x)]; };
    CHECK(texel(0, 0) == texel(17, 17));
    CHECK(texel(0, 0) != texel(17, 0));
}
