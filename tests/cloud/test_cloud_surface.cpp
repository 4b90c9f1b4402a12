#include "preprocess/cloud/cloud_surface.h"
#include "preprocess/cloud/orient_normals.h"
#include "preprocess/cloud/voronoi_cell.h"
#include "tests/cloud/cloud_shapes.h"

#include <catch2/catch.hpp>
#include <tbb/global_control.h>

#include <cmath>
#include <cstring>

using namespace splice;
using namespace splice::test;

namespace {

CloudSurface oriented_surface(const UnitCloud& cloud, const CloudOptions& options = {}) {
    CloudSurface surface = estimate_surface(cloud, options);
    orient_normals(cloud.positions, surface.neighbours, surface.disks);
    return surface;
}

// Points of `surface` under no disk: within its radius along the plane, and across it no farther than the surface can
// be, given that two planes in a neighbourhood of radius r may bend apart.
std::size_t bare_points(const UnitCloud& cloud, const std::vector<CloudDisk>& disks, const std::vector<Vec3f>& surface,
                        std::vector<int>* overlap = nullptr) {
    float largest = 0;
    for (const CloudDisk& disk : disks)
        largest = std::max(largest, disk.radius);
    // Cells as wide as the largest disk, so that what covers a point is in the 27 around it.
    const auto cells = static_cast<int>(std::max(1.0f, 1 / largest));
    const auto cell_of = [&](float x) {
        return std::clamp(static_cast<int>((x + 0.5f) * static_cast<float>(cells)), 0, cells - 1);
    };
    std::vector<std::vector<std::uint32_t>> grid(static_cast<std::size_t>(cells) * cells * cells);
    const auto at = [&](int x, int y, int z) -> auto& {
        return grid[(static_cast<std::size_t>(z) * static_cast<std::size_t>(cells) + static_cast<std::size_t>(y)) *
                        static_cast<std::size_t>(cells) +
                    static_cast<std::size_t>(x)];
    };
    for (std::uint32_t i = 0; i < disks.size(); ++i) {
        const Vec3f& p = cloud.positions[i];
        at(cell_of(p.x()), cell_of(p.y()), cell_of(p.z())).push_back(i);
    }
    std::size_t bare = 0;
    for (const Vec3f& p : surface) {
        int covered = 0;
        for (int z = std::max(0, cell_of(p.z()) - 1); z <= std::min(cells - 1, cell_of(p.z()) + 1); ++z)
            for (int y = std::max(0, cell_of(p.y()) - 1); y <= std::min(cells - 1, cell_of(p.y()) + 1); ++y)
                for (int x = std::max(0, cell_of(p.x()) - 1); x <= std::min(cells - 1, cell_of(p.x()) + 1); ++x)
                    for (const std::uint32_t i : at(x, y, z)) {
                        const Vec3f offset = p - cloud.positions[i];
                        const float height = offset.dot(disks[i].normal);
                        const Vec3f along = offset - height * disks[i].normal;
                        covered += along.norm() <= disks[i].radius && std::abs(height) <= 0.5f * disks[i].radius;
                    }
        bare += covered == 0;
        if (overlap != nullptr) overlap->push_back(covered);
    }
    return bare;
}

}  // namespace

TEST_CASE("a Voronoi cell of a square lattice is its square") {
    VoronoiCell cell(10);
    CHECK_FALSE(cell.is_bounded());
    std::uint32_t number = 0;
    for (const Eigen::Vector2f& site : {Eigen::Vector2f(1, 0), {0, 1}, {-1, 0}, {0, -1}})
        CHECK(cell.cut(site, number++));
    CHECK(cell.is_bounded());
    CHECK(cell.reach(true) == Approx(std::sqrt(0.5)));
    CHECK(cell.reach(false) == Approx(std::sqrt(0.5)));
    CHECK_FALSE(cell.cut({2, 0}, 9));
    CHECK_FALSE(cell.cut({1.01f, 1.01f}, 9));
    std::vector<std::uint32_t> around;
    cell.neighbours([&](std::uint32_t n) { around.push_back(n); });
    CHECK(around.size() == 4);
}

TEST_CASE("a Voronoi cell that is open on one side tells") {
    VoronoiCell cell(10);
    cell.cut({1, 0}, 0);
    cell.cut({0, 1}, 1);
    cell.cut({0, -1}, 2);
    CHECK_FALSE(cell.is_bounded());
    CHECK(cell.reach(false) > 9);
    CHECK(cell.reach(true) == Approx(std::sqrt(0.5)));
}

TEST_CASE("normals of a sphere and a torus are found and face outward") {
    const UnitCloud sphere = unit_cloud(sphere_points(40000, 1));
    const CloudSurface on_sphere = oriented_surface(sphere);
    CHECK(on_sphere.estimated_normals == 40000);
    float worst = 1;
    double mean = 0;
    for (std::size_t i = 0; i < sphere.positions.size(); ++i) {
        const float cosine = on_sphere.disks[i].normal.dot(sphere.positions[i].normalized());
        worst = std::min(worst, cosine);
        mean += static_cast<double>(cosine) / 40000;
    }
    CHECK(worst > std::cos(0.1f));
    CHECK(mean > std::cos(0.03));

    // One of the two circles through the hole closes a loop that a wrong turn would show on.
    PointCloud source;
    std::vector<Vec3f> normals;
    source.offsets = torus_points(60000, 2, &normals);
    for (std::uint32_t i = 0; i < 60000; ++i)
        source.colours.push_back(i);
    const UnitCloud torus = make_unit_cloud(std::move(source));
    const CloudSurface on_torus = oriented_surface(torus);
    worst = 1;
    for (std::size_t i = 0; i < torus.positions.size(); ++i)
        worst = std::min(worst, on_torus.disks[i].normal.dot(normals[torus.colours[i]]));
    CHECK(worst > std::cos(0.3f));
}

TEST_CASE("where noise is as wide as the spacing, planes are of more neighbours and normals still face outward") {
    // The spacing is 0.0125; within 16 neighbours' reach the points fill space.
    std::vector<Vec3f> points = sphere_points(20000, 1);
    std::mt19937 random(2);
    std::normal_distribution<float> noise(0, 0.02f);
    for (Vec3f& point : points)
        point *= 1 + noise(random) / 0.5f;
    const UnitCloud cloud = unit_cloud(std::move(points));
    const auto inward = [&](const CloudOptions& options, int neighbours) {
        const CloudSurface surface = oriented_surface(cloud, options);
        CHECK(surface.plane_neighbours == neighbours);
        std::size_t count = 0;
        for (std::size_t i = 0; i < cloud.positions.size(); ++i)
            count += surface.disks[i].normal.dot(cloud.positions[i]) <= 0;
        return count;
    };
    CHECK(inward({}, kNoisyNeighbours) < 20);
    CHECK(inward({.neighbours = kUsualNeighbours}, kUsualNeighbours) > 1000);
    CHECK(estimate_surface(unit_cloud(sphere_points(20000, 1)), {}).plane_neighbours == kUsualNeighbours);
}

TEST_CASE("two thin sheets back to back face away from each other") {
    // A slab a fifth of the spacing thick would be too much to ask; one of twice the spacing is not.
    PointCloud cloud;
    for (int side = 0; side < 2; ++side)
        for (int y = 0; y < 100; ++y)
            for (int x = 0; x < 100; ++x)
                cloud.offsets.emplace_back(static_cast<float>(x) + 0.3f * static_cast<float>(y % 2),
                                           static_cast<float>(y), 2.0f * static_cast<float>(side));
    const UnitCloud unit = make_unit_cloud(std::move(cloud));
    const CloudSurface surface = oriented_surface(unit);
    std::size_t inconsistent = 0;
    for (int side = 0; side < 2; ++side) {
        int up = 0, down = 0;
        for (std::size_t i = 0; i < unit.positions.size(); ++i)
            if ((unit.positions[i].z() > 0) == (side == 1)) ++(surface.disks[i].normal.z() > 0 ? up : down);
        inconsistent += static_cast<std::size_t>(std::min(up, down));
    }
    CHECK(inconsistent == 0);
}

TEST_CASE("disks leave no point of a randomly sampled surface bare, and are few over each") {
    for (const bool torus : {false, true}) {
        INFO((torus ? "torus" : "sphere"));
        const auto shape = [&](std::size_t count, unsigned seed) {
            return torus ? torus_points(count, seed) : sphere_points(count, seed);
        };
        // Corners of the cloud's box are not quite the shape's: test points go through the same transform.
        PointCloud source;
        source.offsets = shape(30000, 3);
        const UnitCloud cloud = make_unit_cloud(std::move(source));
        std::vector<Vec3f> tests = shape(200000, 4);
        for (Vec3f& p : tests)
            p = ((p.cast<double>() - cloud.source_offset) / cloud.source_scale).cast<float>();
        const CloudSurface surface = oriented_surface(cloud);
        CHECK(surface.border_points == 0);
        std::vector<int> overlap;
        CHECK(bare_points(cloud, surface.disks, tests, &overlap) == 0);
        double mean = 0;
        for (const int disks : overlap)
            mean += disks / 200000.0;
        CHECK(mean < 8);  // a random sampling has voids; the ellipse around 16 neighbours would lie 16 deep
    }
}

TEST_CASE("a hole in a plane smaller than the search is closed, a larger one is a border") {
    const auto plane_with_hole = [](float radius) {
        PointCloud cloud;
        for (int y = 0; y < 120; ++y)
            for (int x = 0; x < 120; ++x) {
                const Vec3f p(static_cast<float>(x) + 0.01f * static_cast<float>((x * 7 + y * 3) % 11),
                              static_cast<float>(y), 0);
                if ((p - Vec3f(60, 60, 0)).norm() > radius) cloud.offsets.push_back(p);
            }
        return make_unit_cloud(std::move(cloud));
    };
    const auto centre_is_bare = [](const UnitCloud& cloud) {
        const Vec3f centre = ((Vec3d(60, 60, 0) - cloud.source_offset) / cloud.source_scale).cast<float>();
        return bare_points(cloud, oriented_surface(cloud).disks, {centre}) == 1;
    };
    CHECK_FALSE(centre_is_bare(plane_with_hole(0)));
    CHECK_FALSE(centre_is_bare(plane_with_hole(1.5f)));
    CHECK(centre_is_bare(plane_with_hole(20)));
}

TEST_CASE("isolated points keep small disks") {
    PointCloud cloud;
    for (int y = 0; y < 100; ++y)
        for (int x = 0; x < 100; ++x)
            cloud.offsets.emplace_back(static_cast<float>(x) + 0.3f * static_cast<float>(y % 2), static_cast<float>(y),
                                       0);
    cloud.offsets.emplace_back(50, 50, 60);
    cloud.offsets.emplace_back(50, 54, 60);
    const UnitCloud unit = make_unit_cloud(std::move(cloud));
    const CloudSurface surface = oriented_surface(unit);
    CHECK(surface.isolated_points >= 2);
    for (const CloudDisk& disk : surface.disks)
        CHECK(disk.radius < 4.0f / 100);
}

TEST_CASE("degenerate clouds: one point, two, a line, a lattice in space") {
    const auto check = [](std::vector<Vec3f> points) {
        const UnitCloud cloud = unit_cloud(std::move(points));
        const CloudSurface surface = oriented_surface(cloud);
        bool usable = surface.disks.size() == cloud.positions.size();
        for (const CloudDisk& disk : surface.disks) {
            usable = usable && std::abs(disk.normal.norm() - 1) < 1e-4f && disk.radius > 0 && disk.radius < 2;
            usable =
                usable && disk.above >= 0 && disk.above <= disk.radius && disk.below >= 0 && disk.below <= disk.radius;
        }
        CHECK(usable);
    };
    check({{1, 2, 3}});
    check({{1, 2, 3}, {1, 2, 4}});
    check({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
    std::vector<Vec3f> line, space;
    for (int i = 0; i < 500; ++i)
        line.emplace_back(static_cast<float>(i), static_cast<float>(2 * i), 0);
    for (int i = 0; i < 1000; ++i)
        space.emplace_back(static_cast<float>(i % 10), static_cast<float>(i / 10 % 10), static_cast<float>(i / 100));
    check(line);
    check(space);
    check({{0, 0, 0}, {1e-30f, 0, 0}, {1, 0, 0}});
}

TEST_CASE("given normals are kept, missing ones estimated") {
    PointCloud cloud;
    cloud.offsets = sphere_points(2000, 9);
    cloud.normals.assign(2000, Vec3f(0, 0, 2));
    cloud.normals[17] = Vec3f::Zero();
    const UnitCloud unit = make_unit_cloud(std::move(cloud));
    const CloudSurface surface = estimate_surface(unit, {});
    CHECK(surface.estimated_normals == 1);
    std::size_t kept = 0;
    for (const CloudDisk& disk : surface.disks)
        kept += disk.normal == Vec3f::UnitZ();
    CHECK(kept >= 1999);
}

TEST_CASE("the surface does not depend on the threads") {
    const UnitCloud cloud = unit_cloud(torus_points(30000, 10));
    const CloudSurface many = oriented_surface(cloud);
    const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
    const CloudSurface alone = oriented_surface(cloud);
    CHECK(std::memcmp(many.disks.data(), alone.disks.data(), many.disks.size() * sizeof(CloudDisk)) == 0);
    CHECK(many.neighbours == alone.neighbours);
}
