#include "tests/cloud/cloud_checks.h"
#include "tests/cloud/cloud_shapes.h"

#include <tbb/global_control.h>

using namespace splice;
using namespace splice::test;

TEST_CASE("a cloud fills the unit box, and the way back is stored") {
    PointCloud cloud;
    cloud.origin = {636000.125, 4848000.25, 400};
    cloud.offsets = {{0, 0, 0}, {10, 2, 0}, {5, 1, 4}, {-10, 0, 1}};
    cloud.colours = {1, 2, 3, 4};
    const PointCloud source = cloud;
    const UnitCloud unit = make_unit_cloud(std::move(cloud));
    CHECK(unit.source_scale == 20);
    REQUIRE(unit.positions.size() == 4);
    for (std::size_t i = 0; i < 4; ++i) {
        CHECK(unit.positions[i].cwiseAbs().maxCoeff() <= 0.5f);
        const Vec3d back = unit.positions[i].cast<double>() * unit.source_scale + unit.source_offset;
        CHECK((back - source_point(source, unit.colours[i] - 1)).norm() < 1e-5);
    }
}

TEST_CASE("survey coordinates keep their millimetres") {
    // Two kilometres, to the millimetre, at UTM coordinates that a float rounds to half a metre.
    std::mt19937 random(6);
    std::uniform_int_distribution<int> millimetres(0, 2000000);
    PointCloud cloud;
    cloud.origin = {512345.678, 5403059.123, 247.5};
    std::vector<Vec3d> exact;
    for (int i = 0; i < 2000; ++i) {
        const Vec3d offset = Vec3d(millimetres(random), millimetres(random), millimetres(random) / 10) / 1000;
        cloud.offsets.push_back(offset.cast<float>());
        cloud.colours.push_back(static_cast<std::uint32_t>(i));
        exact.push_back(cloud.origin + offset);
    }
    const UnitCloud unit = make_unit_cloud(std::move(cloud));
    double worst = 0;
    for (std::size_t i = 0; i < unit.positions.size(); ++i) {
        const Vec3d back = unit.positions[i].cast<double>() * unit.source_scale + unit.source_offset;
        worst = std::max(worst, (back - exact[unit.colours[i]]).cwiseAbs().maxCoeff());
    }
    CHECK(worst < 0.0002);
}

TEST_CASE("duplicates are dropped and counted, the first of the file stays") {
    PointCloud cloud;
    cloud.offsets = {{1, 1, 1}, {0, 0, 0}, {1, 1, 1}, {1, 1, 1}, {0, 0, 0}};
    cloud.colours = {10, 20, 30, 40, 50};
    UnitCloud unit = make_unit_cloud(std::move(cloud));
    CHECK(unit.duplicate_points == 3);
    std::sort(unit.colours.begin(), unit.colours.end());
    CHECK(unit.colours == std::vector<std::uint32_t>{10, 20});

    cloud = {};
    cloud.offsets.assign(1000, {3, 2, 1});
    unit = make_unit_cloud(std::move(cloud));
    CHECK(unit.positions.size() == 1);
    CHECK(unit.source_scale > 0);
}

TEST_CASE("the order of points does not depend on the threads") {
    const UnitCloud many = unit_cloud(sphere_points(50000, 7));
    const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
    CHECK(unit_cloud(sphere_points(50000, 7)).positions == many.positions);
}
