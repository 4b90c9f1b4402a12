#include "preprocess/lod/point_octree.h"
#include "preprocess/mesh/indexed_mesh.h"
#include "preprocess/model_format/half.h"
#include "preprocess/model_format/octahedral.h"
#include "preprocess/model_format/surfel_extent.h"
#include "preprocess/model_format/tangent_frame.h"

#include <catch2/catch.hpp>
#include <tbb/global_control.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstring>
#include <numbers>
#include <random>

using namespace splice;
using format::PointNode;
using format::Surfel;

namespace {

Surfel disk(const Vec3f& position, const Vec3f& normal, float radius, std::uint8_t grey = 200) {
    Surfel surfel{};
    std::copy_n(position.data(), 3, surfel.position);
    surfel.radius = half_at_least(radius);
    surfel.extent = encode_extent({radius / 8, radius / 16, radius}, float_from_half(surfel.radius));
    surfel.normal = encode_octahedral(normal.x(), normal.y(), normal.z());
    std::fill_n(surfel.colour, 3, grey);
    return surfel;
}

// Disks over a bumpy sphere, dense on one side.
std::vector<Surfel> bumpy_sphere(std::size_t count, unsigned seed) {
    std::mt19937 random(seed);
    std::normal_distribution<float> normal;
    std::vector<Surfel> surfels;
    while (surfels.size() < count) {
        const Vec3f n = Vec3f(normal(random), normal(random), 0.3f * normal(random)).normalized();
        const float bump = 0.45f + 0.03f * std::sin(14 * n.x()) * std::sin(11 * n.y());
        surfels.push_back(disk(bump * n, n + 0.1f * Vec3f(normal(random), normal(random), normal(random)),
                               0.02f + 0.01f * std::abs(n.z())));
    }
    return surfels;
}

Vec3d vector_of(const float (&v)[3]) {
    return Vec3f(v[0], v[1], v[2]).cast<double>();
}
Vec3d normal_of(std::uint32_t bits) {
    const auto n = decode_octahedral(bits);
    return Vec3f(n[0], n[1], n[2]).cast<double>();
}

// Points on the rim of a disk, of its plane and of both ends of its solid.
std::vector<Vec3d> rim(const Surfel& surfel, bool solid) {
    const float radius = float_from_half(surfel.radius);
    const SurfelExtent extent = decode_extent(surfel.extent, radius);
    const TangentFrame frame = tangents_of(decode_octahedral(surfel.normal));
    const Vec3d s = Vec3f(frame.s[0], frame.s[1], frame.s[2]).cast<double>();
    const Vec3d t = Vec3f(frame.t[0], frame.t[1], frame.t[2]).cast<double>();
    std::vector<Vec3d> points;
    for (int i = 0; i < 16; ++i) {
        const double angle = i * std::numbers::pi / 8;
        const Vec3d point =
            vector_of(surfel.position) + static_cast<double>(radius) * (std::cos(angle) * s + std::sin(angle) * t);
        points.push_back(point);
        if (!solid) continue;
        points.push_back(point + static_cast<double>(extent.above) * normal_of(surfel.normal));
        points.push_back(point - static_cast<double>(extent.below) * normal_of(surfel.normal));
    }
    return points;
}

struct Faults {
    std::size_t ellipse = 0, sphere = 0, cone = 0;
};

Faults bounds_that_fail(const std::vector<PointNode>& nodes, const std::vector<Surfel>& surfels) {
    Faults faults;
    for (const PointNode& node : nodes) {
        const Vec3d centre = vector_of(node.position), normal = normal_of(node.normal),
                    major = normal_of(node.major_axis);
        const Vec3d minor = normal.cross(major);
        for (std::uint32_t i = 0; i < node.surfel_count; ++i) {
            const Surfel& surfel = surfels[node.first_surfel + i];
            for (const Vec3d& point : rim(surfel, false)) {
                const double x = (point - centre).dot(major) / static_cast<double>(node.major);
                const double y = (point - centre).dot(minor) / static_cast<double>(node.minor);
                faults.ellipse += std::hypot(x, y) > 1 + 1e-6;
            }
            for (const Vec3d& point : rim(surfel, true))
                faults.sphere += (point - centre).norm() > static_cast<double>(node.sphere_radius) + 1e-6;
            const double angle = std::acos(std::clamp(normal_of(surfel.normal).dot(normal), -1.0, 1.0));
            faults.cone += angle > node.cone_angle * std::numbers::pi / 255;
        }
    }
    return faults;
}

// Breadth first, children contiguous and dividing their parent's surfels, leaves small.
void check_shape(const std::vector<PointNode>& nodes, std::size_t surfels) {
    REQUIRE_FALSE(nodes.empty());
    CHECK(nodes[0].first_surfel == 0);
    CHECK(nodes[0].surfel_count == surfels);
    std::size_t next = 1, faults = 0;
    for (const PointNode& node : nodes) {
        faults += node.surfel_count == 0;
        if (node.child_count == 0) {
            faults += node.surfel_count > kPointLeaf || node.first_child != 0;
            continue;
        }
        faults += node.first_child != next || node.child_count < 2 || node.child_count > 8;
        std::uint32_t surfel = node.first_surfel;
        for (std::uint32_t child = 0; child < node.child_count; ++child) {
            const PointNode& part = nodes.at(node.first_child + child);
            faults += part.first_surfel != surfel;
            surfel += part.surfel_count;
        }
        faults += surfel != node.first_surfel + node.surfel_count;
        next += node.child_count;
    }
    CHECK(next == nodes.size());
    CHECK(faults == 0);
}

}  // namespace

TEST_CASE("each surfel is in one leaf, and only once") {
    std::vector<Surfel> surfels = bumpy_sphere(20000, 1);
    for (std::uint16_t i = 0; i < surfels.size(); ++i)
        surfels[i].patch = i;  // a label
    const std::vector<PointNode> nodes = build_point_octree(surfels);
    check_shape(nodes, 20000);
    std::vector<bool> seen(20000, false);
    for (const Surfel& surfel : surfels)
        seen[surfel.patch] = true;
    CHECK(std::count(seen.begin(), seen.end(), true) == 20000);
    CHECK(nodes.size() < surfels.size() / 2);
}

TEST_CASE("a node's children are the octants about the mean of its points") {
    std::vector<Surfel> surfels = bumpy_sphere(5000, 2);
    const std::vector<PointNode> nodes = build_point_octree(surfels);
    std::size_t shared = 0;
    for (const PointNode& node : nodes) {
        std::vector<int> octants;
        Vec3d mean = Vec3d::Zero();
        for (std::uint32_t i = 0; i < node.surfel_count; ++i)
            mean += vector_of(surfels[node.first_surfel + i].position) / node.surfel_count;
        CHECK((mean - vector_of(node.position)).norm() < 1e-6);
        for (std::uint32_t child = 0; child < node.child_count; ++child) {
            const PointNode& part = nodes[node.first_child + child];
            int first = -1;
            for (std::uint32_t i = 0; i < part.surfel_count; ++i) {
                const Vec3d p = vector_of(surfels[part.first_surfel + i].position) - mean;
                const int octant = (p.x() > 0 ? 1 : 0) | (p.y() > 0 ? 2 : 0) | (p.z() > 0 ? 4 : 0);
                if (first < 0) first = octant;
                shared += octant != first && p.cwiseAbs().minCoeff() > 1e-9;
            }
            octants.push_back(first);
        }
        shared += std::adjacent_find(octants.begin(), octants.end()) != octants.end();
    }
    CHECK(shared == 0);
}

TEST_CASE("ellipses, spheres and cones hold every disk below their node, at every level") {
    for (const std::size_t count : {1u, 2u, 17u, 300u, 20000u}) {
        INFO(count << " disks");
        std::vector<Surfel> surfels = bumpy_sphere(count, 3);
        const std::vector<PointNode> nodes = build_point_octree(surfels);
        check_shape(nodes, count);
        const Faults faults = bounds_that_fail(nodes, surfels);
        CHECK(faults.ellipse == 0);
        CHECK(faults.sphere == 0);
        CHECK(faults.cone == 0);
    }
}

TEST_CASE("bounds are not much larger than what they hold") {
    // A flat square of disks: at every level an ellipse covers at most a few times the area of its part of the square.
    std::vector<Surfel> surfels;
    for (int y = 0; y < 128; ++y)
        for (int x = 0; x < 128; ++x)
            surfels.push_back(disk({static_cast<float>(x) / 128 - 0.5f, static_cast<float>(y) / 128 - 0.5f, 0},
                                   Vec3f::UnitZ(), 0.8f / 128));
    const std::vector<PointNode> nodes = build_point_octree(surfels);
    for (const PointNode& node : nodes) {
        const double own = static_cast<double>(node.surfel_count) / (128 * 128);
        const double ellipse = std::numbers::pi * static_cast<double>(node.major) * static_cast<double>(node.minor);
        CHECK(ellipse < 5 * own + 40.0 / (128 * 128));
        CHECK(node.cone_angle <= 4);  // nothing but rounding, upward once a level above 512 disks, and twice below
        CHECK(std::abs(normal_of(node.normal).z()) > 0.999);
    }
}

TEST_CASE("colours and normals are means over area, in linear light") {
    // Black and white disks of equal area: half the light is sRGB 188, not 128.
    std::vector<Surfel> surfels = {disk({0, 0, 0}, {0, 0, 1}, 0.1f, 0), disk({0.3f, 0, 0}, {1, 0, 1}, 0.1f, 255)};
    const std::vector<PointNode> nodes = build_point_octree(surfels);
    REQUIRE(nodes.size() == 1);
    CHECK(int{nodes[0].colour[0]} == Approx(188).margin(1));
    CHECK(std::acos(normal_of(nodes[0].normal).z()) == Approx(std::numbers::pi / 8).margin(1e-3));
}

TEST_CASE("normals that cancel out leave a cone of all directions") {
    std::vector<Surfel> surfels = {disk({0, 0, 0}, {0, 0, 1}, 0.1f), disk({0, 0, -0.1f}, {0, 0, -1}, 0.1f)};
    CHECK(build_point_octree(surfels)[0].cone_angle == 255);
}

TEST_CASE("points that halve their distance again and again, or coincide, end") {
    std::vector<Surfel> surfels;
    for (int i = 0; i < 120; ++i)
        surfels.push_back(disk({std::ldexp(0.5f, -i), 0, 0}, Vec3f::UnitZ(), 0.001f));
    for (int i = 0; i < 100; ++i)
        surfels.push_back(disk({0.25f, 0.25f, 0}, Vec3f::UnitZ(), 0.001f));
    const std::vector<PointNode> nodes = build_point_octree(surfels);
    check_shape(nodes, 220);
    CHECK(bounds_that_fail(nodes, surfels).ellipse == 0);
}

TEST_CASE("no surfels, no tree, the tree does not depend on the threads") {
    std::vector<Surfel> none;
    CHECK(build_point_octree(none).empty());
    std::vector<Surfel> many = bumpy_sphere(30000, 4), alone = many;
    const std::vector<PointNode> tree = build_point_octree(many);
    const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
    const std::vector<PointNode> again = build_point_octree(alone);
    REQUIRE(again.size() == tree.size());
    CHECK(std::memcmp(tree.data(), again.data(), tree.size() * sizeof(PointNode)) == 0);
    CHECK(std::memcmp(many.data(), alone.data(), many.size() * sizeof(Surfel)) == 0);
}
