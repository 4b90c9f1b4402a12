#include "tests/reference/reference_scene.h"

#include <catch2/catch.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include <cmath>
#include <numbers>

using namespace splice;
using namespace splice::reference;

namespace {

/// A latitude-longitude sphere of the given radius, outward normals.
IndexedMesh sphere(float radius, std::uint32_t rings) {
    IndexedMesh mesh;
    const std::uint32_t segments = 2 * rings;
    const auto pi = std::numbers::pi_v<float>;
    for (std::uint32_t i = 0; i <= rings; ++i)
        for (std::uint32_t j = 0; j < segments; ++j) {
            const float theta = pi * static_cast<float>(i) / static_cast<float>(rings);
            const float phi = 2 * pi * static_cast<float>(j) / static_cast<float>(segments);
            mesh.positions.emplace_back(
                Vec3f(std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)) * radius);
        }
    const auto id = [&](std::uint32_t i, std::uint32_t j) { return i * segments + j % segments; };
    for (std::uint32_t i = 0; i < rings; ++i)
        for (std::uint32_t j = 0; j < segments; ++j) {
            if (i > 0) mesh.triangles.push_back({id(i, j), id(i + 1, j), id(i, j + 1)});
            if (i + 1 < rings) mesh.triangles.push_back({id(i, j + 1), id(i + 1, j), id(i + 1, j + 1)});
        }
    for (const Triangle& t : mesh.triangles)
        for (const std::uint32_t v : t)
            mesh.corner_normals.push_back(mesh.positions[v].normalized());
    mesh.materials.push_back({});
    return mesh;
}

/// One square in the plane z = 0, side 1, four quadrants of colour through a 2x2 texture.
IndexedMesh textured_square() {
    IndexedMesh mesh;
    mesh.positions = {{-0.5f, -0.5f, 0}, {0.5f, -0.5f, 0}, {0.5f, 0.5f, 0}, {-0.5f, 0.5f, 0}};
    mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
    mesh.corner_normals.assign(6, Vec3f::UnitZ());
    const Vec2f a(0, 1), b(1, 1), c(1, 0), d(0, 0);
    mesh.corner_uvs = {a, b, c, a, c, d};
    mesh.images.push_back({2, 2, {255, 0, 0, 255, 0, 255, 0, 255, 0, 0, 255, 255, 255, 255, 255, 255}});
    mesh.materials.push_back({"m", kWhite, 0});
    return mesh;
}

glm::dmat4 flip_y(glm::dmat4 projection) {
    projection[1][1] *= -1;
    return projection;
}

glm::vec3 albedo(const SurfacePoint& point) {
    return point.colour;
}

}  // namespace

TEST_CASE("a perspective ray through a pixel projects back to that pixel") {
    ReferenceView view{glm::lookAt(glm::dvec3(1, 2, 3), glm::dvec3(0), glm::dvec3(0, 1, 0)),
                       flip_y(glm::perspective(0.7, 4.0 / 3.0, 0.1, 10.0)), 64, 48};
    const Ray ray = pixel_ray(view, 10.5, 40.5);
    CHECK(glm::length(ray.direction) == Approx(1));
    const glm::dvec4 clip = view.projection * glm::dvec4(ray.origin + 2.5 * ray.direction, 1);
    CHECK((clip.x / clip.w + 1) / 2 * view.width == Approx(10.5));
    CHECK((clip.y / clip.w + 1) / 2 * view.height == Approx(40.5));
    CHECK(clip.z / clip.w > 0);
}

TEST_CASE("orthographic rays are parallel and start in the plane of the eye") {
    const ReferenceView view{glm::dmat4(1), flip_y(glm::ortho(-2.0, 2.0, -1.0, 1.0, 0.1, 10.0)), 40, 20};
    const Ray ray = pixel_ray(view, 30, 5);
    CHECK(ray.direction == glm::dvec3(0, 0, -1));
    CHECK(ray.origin.x == Approx(1));
    CHECK(ray.origin.y == Approx(0.5));  // y is down in the window
    CHECK(ray.origin.z == Approx(0));
}

TEST_CASE("depth of a sphere is the analytic distance along the view direction") {
    const IndexedMesh mesh = sphere(0.5f, 200);
    const ReferenceScene scene(mesh);
    for (const glm::dvec3& direction : view_directions()) {
        const glm::dvec3 up = std::abs(direction.y) > 0.9 ? glm::dvec3(0, 0, 1) : glm::dvec3(0, 1, 0);
        const ReferenceView view{glm::lookAt(3.0 * direction, glm::dvec3(0), up),
                                 flip_y(glm::perspective(0.5, 1.0, 0.1, 10.0)), 33, 33};
        const DepthImage depth = scene.depth(view);
        std::size_t hits = 0;
        for (std::uint32_t y = 0; y < view.height; ++y)
            for (std::uint32_t x = 0; x < view.width; ++x) {
                const Ray ray = pixel_ray(view, x + 0.5, y + 0.5);
                const glm::dvec3 centre(0, 0, -3);
                const double b = glm::dot(ray.direction, centre);
                const double discriminant = b * b - 9 + 0.25;
                if (std::abs(discriminant) < 2e-3) continue;  // the silhouette, where a polygon is no sphere
                CHECK((depth.at(x, y) != kNothing) == (discriminant > 0));
                if (depth.at(x, y) == kNothing) continue;
                ++hits;
                CHECK(depth.at(x, y) == Approx((b - std::sqrt(discriminant)) * -ray.direction.z).margin(1e-3));
            }
        CHECK(hits > 300);
    }
}

TEST_CASE("window rows run downwards and the texture stands upright") {
    const IndexedMesh mesh = textured_square();
    const ReferenceScene scene(mesh);
    const ReferenceView view{glm::translate(glm::dmat4(1), glm::dvec3(0, 0, -1)),
                             flip_y(glm::ortho(-0.5, 0.5, -0.5, 0.5, 0.1, 10.0)), 8, 8};
    const ColourImage image = scene.shaded(view, albedo, glm::vec3(0));
    // Texel centres: a quarter in from each corner, pixels 1..2 and 5..6 average symmetrically around them.
    CHECK(image.at(2, 2).r > image.at(2, 2).g);
    CHECK(image.at(5, 2).g > image.at(5, 2).r);
    CHECK(image.at(2, 5).b > image.at(2, 5).r);
    for (const int channel : {image.at(5, 5).r, image.at(5, 5).g, image.at(5, 5).b})
        CHECK(channel > 180);
}

TEST_CASE("samples are averaged in linear light and the background shows where nothing is hit") {
    IndexedMesh mesh = textured_square();
    mesh.materials[0].image = kNoImage;
    const ReferenceScene scene(mesh);
    // The right half of the middle column of pixels is covered: white over black, half and half.
    const ReferenceView view{glm::translate(glm::dmat4(1), glm::dvec3(0.5, 0, -1)),
                             flip_y(glm::ortho(-0.5, 0.5, -0.5, 0.5, 0.1, 10.0)), 5, 5};
    const ColourImage image = scene.shaded(view, albedo, glm::vec3(0));
    CHECK(static_cast<int>(image.at(0, 2).r) == 0);
    CHECK(static_cast<int>(image.at(4, 2).r) == 255);
    CHECK(static_cast<int>(image.at(2, 2).r) == Approx(188).margin(1));  // sRGB of 0.5; averaging codes would give 128
}

TEST_CASE("a uniformly scaled instance is seen at its world distance") {
    const IndexedMesh mesh = sphere(0.5f, 60);
    const ReferenceScene scene(mesh);
    const glm::dmat4 model = glm::scale(glm::dmat4(1), glm::dvec3(4));
    const ReferenceView view{glm::lookAt(glm::dvec3(0, 0, 10), glm::dvec3(0), glm::dvec3(0, 1, 0)) * model,
                             flip_y(glm::perspective(0.5, 1.0, 0.1, 100.0)), 9, 9};
    CHECK(scene.depth(view).at(4, 4) == Approx(8).margin(0.02));
}

TEST_CASE("where an outline passes through a pixel's centre, either side of it is what the pixel may show") {
    // A plate whose edge is the plane x = 0, and behind it a steep slope: the depth there, 4 - x, changes from pixel to
    // pixel by more than a depth buffer's rounding, so no ray beside the centre finds the very depth at it.
    IndexedMesh mesh;
    mesh.positions = {{-3, -3, 1}, {0, -3, 1}, {0, 3, 1}, {-3, 3, 1}, {-3, -3, -3}, {3, -3, 3}, {3, 3, 3}, {-3, 3, -3}};
    mesh.triangles = {{0, 1, 2}, {0, 2, 3}, {4, 5, 6}, {4, 6, 7}};
    mesh.corner_normals.assign(12, Vec3f::UnitZ());
    mesh.materials.push_back({});
    const ReferenceScene scene(mesh);
    // 9 pixels over 4.5 units: the middle one's centre looks along x = 0.
    ReferenceView view;
    view.view = glm::translate(glm::dmat4(1), glm::dvec3(0, 0, -4));
    view.projection = flip_y(glm::orthoRH_ZO(-2.25, 2.25, -2.25, 2.25, 0.1, 10.0));
    view.width = view.height = 9;
    const DepthRange range = scene.range_in_pixel(view, 4, 4);
    CHECK(range.nearest == Approx(3));
    CHECK(range.farthest == Approx(4 + 0.5 / 512));  // the grid's nearest ray beside it meets 4 - 1/64
    // A pixel to the left there is the plate alone.
    CHECK(scene.range_in_pixel(view, 3, 4).farthest == Approx(3));
}

TEST_CASE("a wall seen from its edge may show a little nearer or farther, as its corners are moved") {
    // The wall x = 0.01 z: 100 deep where it is a pixel wide.
    IndexedMesh mesh;
    mesh.positions = {{-0.5f, -3, -50}, {0.5f, -3, 50}, {0.5f, 3, 50}, {-0.5f, 3, -50}};
    mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
    mesh.corner_normals.assign(6, Vec3f::UnitX());
    mesh.materials.push_back({});
    const ReferenceScene scene(mesh);
    ReferenceView view;
    view.view = glm::translate(glm::dmat4(1), glm::dvec3(0, 0, -60));
    view.projection = flip_y(glm::orthoRH_ZO(-4.5, 4.5, -4.5, 4.5, 0.1, 200.0));
    view.width = view.height = 9;
    // One ray, through the centre, and no others: what the grid's would find is left out.
    const DepthRange range = scene.range_in_pixel(view, 4, 4, 1);
    CHECK(range.nearest == Approx(60 - 100.0 / 512));
    CHECK(range.farthest == Approx(60 + 100.0 / 512));
}

TEST_CASE("a wall that folds back behind an outline may come to the front beyond it, as corners are moved") {
    // A plate that faces the eye at depth 60 ends where x = -1/1024 px; from its edge a wall runs back below it, 50
    // deep where it is half a pixel wide. At the pixel's centre there is neither; moved over it, the wall is the nearer
    // one.
    constexpr float kEdge = -1.0f / 1024;
    IndexedMesh mesh;
    mesh.positions = {
        {-3, -3, 0},   {kEdge, -3, 0}, {kEdge, 3, 0}, {-3, 3, 0},  {kEdge - 0.5f, -3, -50}, {kEdge - 0.5f, 3, -50},
        {-9, -9, -80}, {9, -9, -80},   {9, 9, -80},   {-9, 9, -80}};
    mesh.triangles = {{0, 1, 2}, {0, 2, 3}, {1, 4, 5}, {1, 5, 2}};
    mesh.corner_normals.assign(12, Vec3f::UnitZ());
    mesh.materials.push_back({});
    ReferenceView view;
    view.view = glm::translate(glm::dmat4(1), glm::dvec3(0, 0, -60));
    view.projection = flip_y(glm::orthoRH_ZO(-4.5, 4.5, -4.5, 4.5, 0.1, 200.0));
    view.width = view.height = 9;
    const DepthRange range = ReferenceScene(mesh).range_in_pixel(view, 4, 4, 1);
    CHECK(range.nearest == Approx(60 - 100.0 * (1.0 / 512 + 1.0 / 1024)));
    // What is hidden stays hidden: it does not excuse a hole through which it shows.
    mesh.triangles.insert(mesh.triangles.end(), {{6, 7, 8}, {6, 8, 9}});
    mesh.corner_normals.assign(18, Vec3f::UnitZ());
    CHECK(ReferenceScene(mesh).range_in_pixel(view, 3, 4, 1).farthest == Approx(60));
}
