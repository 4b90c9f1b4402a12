#include "preprocess/model_format/octahedral.h"
#include "preprocess/simplify/fit_attributes.h"
#include "tests/simplify/patch_meshes.h"

#include <catch2/catch.hpp>
#include <tbb/global_control.h>

#include <cmath>
#include <vector>

using namespace splice;

namespace {

constexpr unsigned kCells = 96, kStep = 8;  // of the fine ground, of its coarse triangles

Vec3f normal_of(const format::Vertex& vertex) {
    return Vec3f(decode_octahedral(vertex.normal).data());
}

// Flat ground whose normals turn, and a coarse level of the same ground with vertices of its own, which have the
// field's own normals.
struct Ground {
    IndexedMesh mesh = test::height_field(kCells, [](float, float) { return 0.0f; });
    RenderVertices render;
    std::vector<SurfaceSample> samples;
    std::vector<std::uint8_t> shared = std::vector<std::uint8_t>(mesh.positions.size(), 0);
    RegionTriangles level;

    explicit Ground(const std::function<Vec3f(const Vec3f&)>& field) {
        for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
            for (std::size_t k = 0; k < 3; ++k)
                mesh.corner_normals[3 * t + k] = field(mesh.positions[mesh.triangles[t][k]]).normalized();
        render = build_render_vertices(mesh);
        for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t)
            samples.push_back(sample_triangle(mesh, render, t));
        const auto own = static_cast<std::uint32_t>(render.vertices.size());
        const unsigned side = kCells / kStep + 1;
        for (unsigned y = 0; y < side; ++y)
            for (unsigned x = 0; x < side; ++x) {
                const Vec3f at(static_cast<float>(x * kStep) / kCells - 0.5f,
                               static_cast<float>(y * kStep) / kCells - 0.5f, 0);
                std::uint32_t nearest = 0;
                for (std::uint32_t i = 0; i < render.vertices.size(); ++i)
                    if ((position(i) - at).norm() < (position(nearest) - at).norm()) nearest = i;
                REQUIRE((position(nearest) - at).norm() < 1e-5f);
                level.vertices.push_back(render.vertices[nearest]);
                level.position.push_back(render.position[nearest]);
                if (x + 1 == side || y + 1 == side) continue;
                const std::uint32_t a = own + y * side + x;
                for (const std::uint32_t corner : {a, a + 1, a + side, a + 1, a + side + 1, a + side})
                    level.corners.push_back(corner);
            }
    }
    Vec3f position(std::uint32_t vertex) const { return mesh.positions[render.position[vertex]]; }

    // Root mean square of what the level's normals differ by at the samples.
    double difference() const {
        const auto own = static_cast<std::uint32_t>(render.vertices.size());
        double sum = 0;
        for (const SurfaceSample& sample : samples)
            for (std::size_t i = 0; i < level.corners.size(); i += 3) {
                const auto at = [&](std::size_t k) {
                    return mesh.positions[level.position[level.corners[i + k] - own]];
                };
                const Vec3f ab = at(1) - at(0), ac = at(2) - at(0), ap = sample.position - at(0);
                const float area = ab.cross(ac).z(), b = ap.cross(ac).z() / area, c = ab.cross(ap).z() / area;
                if (b < 0 || c < 0 || b + c > 1) continue;
                const auto normal = [&](std::size_t k) {
                    return normal_of(level.vertices[level.corners[i + k] - own]);
                };
                const Vec3f mean = (1 - b - c) * normal(0) + b * normal(1) + c * normal(2);
                sum += static_cast<double>((mean.normalized() - sample.normal).squaredNorm());
                break;
            }
        return std::sqrt(sum / static_cast<double>(samples.size()));
    }
    void fit() { fit_attributes(mesh, render, samples, 100'000, shared, level); }
};

Vec3f waves(const Vec3f& at) {
    return {0.4f * std::sin(14 * at.x()), 0.4f * std::cos(14 * at.y()), 1};
}

}  // namespace

// Linear pieces through points of a curve have six times the least mean square, 2.4 times the root of it.
TEST_CASE("fitted normals are nearer to those of the surface between the vertices than the surface's own at them") {
    Ground ground(waves);
    const double before = ground.difference();
    ground.fit();
    CAPTURE(before, ground.difference());
    CHECK(before > 0.005);
    CHECK(ground.difference() < 0.6 * before);
}

TEST_CASE("fitted normals of what is linear are what they were, and those of shared vertices stay in any case") {
    Ground even([](const Vec3f&) { return Vec3f(0.1f, 0.2f, 1); });
    even.fit();
    CHECK(even.difference() < 1e-4);
    Ground ground(waves);
    const std::vector<format::Vertex> before = ground.level.vertices;
    std::size_t changed = 0;
    for (std::size_t i = 0; i < before.size(); i += 2)
        ground.shared[ground.level.position[i]] = 1;
    ground.fit();
    for (std::size_t i = 0; i < before.size(); ++i) {
        const bool same = ground.level.vertices[i].normal == before[i].normal;
        if (i % 2 == 0) CHECK(same);
        changed += same ? 0 : 1;
    }
    CHECK(changed > before.size() / 3);
}

TEST_CASE("fitted normals do not depend on the threads") {
    Ground many(waves), one(waves);
    many.fit();
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, 1);
    one.fit();
    for (std::size_t i = 0; i < one.level.vertices.size(); ++i)
        CHECK(one.level.vertices[i].normal == many.level.vertices[i].normal);
}
