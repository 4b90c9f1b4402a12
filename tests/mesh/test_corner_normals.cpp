#include "preprocess/mesh/shapes.h"
#include "tests/mesh/mesh_checks.h"

#include <cmath>
#include <numbers>

using namespace splice;
using namespace splice::test;

namespace {

Vec3f face_normal(const IndexedMesh& mesh, std::size_t t) {
    const Vec3f a = mesh.positions[mesh.triangles[t][0]];
    return (mesh.positions[mesh.triangles[t][1]] - a).cross(mesh.positions[mesh.triangles[t][2]] - a).normalized();
}

/// Largest angle in degrees between a corner normal and `expected(position, triangle)`.
template <class Expected>
double worst_angle(const IndexedMesh& mesh, Expected expected) {
    double worst = 0;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        for (std::size_t k = 0; k < 3; ++k) {
            const Vec3f n = expected(mesh.positions[mesh.triangles[t][k]], t);
            const double cosine =
                std::min(1.0, static_cast<double>(mesh.corner_normals[3 * t + k].dot(n.normalized())));
            worst = std::max(worst, std::acos(cosine) * 180 / std::numbers::pi);
        }
    }
    return worst;
}

}  // namespace

TEST_CASE("Normals of a sphere are radial, computed across triangles of uneven size") {
    CHECK(worst_angle(repaired(shapes::ico_sphere(20)), [](const Vec3f& p, std::size_t) { return p; }) < 0.3);
    CHECK(worst_angle(repaired(shapes::uv_sphere(60, 40)), [](const Vec3f& p, std::size_t) { return p; }) < 1.5);
}

TEST_CASE("Normals of a cube are those of its faces, however it is triangulated") {
    for (const std::uint32_t cells : {1u, 5u}) {
        const IndexedMesh mesh = repaired(shapes::cube(cells));
        CHECK(worst_angle(mesh, [&](const Vec3f&, std::size_t t) { return face_normal(mesh, t); }) < 0.05);
    }
}

TEST_CASE("Normals are split at creases only: a machined part") {
    const IndexedMesh mesh = repaired(shapes::machined_part(64));
    // On plane faces the corner normal is the face's, chamfers of 45 degrees included; the bore and boss are smooth.
    std::size_t plane_corners = 0, smooth_corners = 0;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        const Vec3f n = face_normal(mesh, t);
        for (std::size_t k = 0; k < 3; ++k) {
            const float cosine = mesh.corner_normals[3 * t + k].dot(n);
            if (std::abs(n.z()) > 0.999f || std::abs(n.x()) > 0.999f || std::abs(n.y()) > 0.999f) {
                const Vec3f& p = mesh.positions[mesh.triangles[t][k]];
                const bool cylinder = std::hypot(p.x(), p.y()) < 0.4f && std::abs(n.z()) < 0.1f;
                if (!cylinder) {
                    CHECK(cosine > 0.9999f);
                    ++plane_corners;
                }
            }
            if (cosine < 0.9999f) {
                CHECK(cosine > std::cos(3.0f * std::numbers::pi_v<float> / 64));
                ++smooth_corners;
            }
        }
    }
    CHECK(plane_corners > 500);
    CHECK(smooth_corners > 500);
}

TEST_CASE("The file's normals are kept, unusable ones are replaced") {
    SourceMesh source = shapes::checkerboard(1, 1);
    const Vec3f tilted = Vec3f(0.1f, 0, 1).normalized();
    source.corner_normals = {2 * tilted, {0, 0, 0}, {0, 0, -1}, {std::nanf(""), 0, 0}};
    RepairReport report;
    const IndexedMesh mesh = repaired(std::move(source), &report);
    check_invariants(mesh);
    std::size_t kept = 0;
    for (const Vec3f& n : mesh.corner_normals) {
        const bool is_given = (n - tilted).norm() < 1e-6f;
        CHECK((is_given || n == Vec3f(0, 0, 1)));
        kept += is_given ? 1 : 0;
    }
    CHECK(kept + report.computed_normals == 6);
    CHECK(kept >= 1);
}

TEST_CASE("Two sheets back to back do not cancel each other's normals") {
    SourceMesh source;
    source.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 1e-9}};
    source.polygon_begin = {0, 3, 6};
    source.corner_position = {0, 1, 2, 2, 1, 3};
    const IndexedMesh mesh = repaired(std::move(source));
    for (const Vec3f& n : mesh.corner_normals)
        CHECK(n.norm() == Approx(1));
}
