#include "tests/cloud/cloud_checks.h"

using namespace splice;
using namespace splice::test;

TEST_CASE("PLY points: ascii, both binary orders, and lists among the properties") {
    const PointCloud ascii = parse_ply_cloud(seed("ply_cloud/ascii.ply"), "x");
    CHECK(ascii.offsets.size() == 1);
    CHECK(ascii.nonfinite_points == 1);
    CHECK(ascii.colours.at(0) == rgb(255, 0, 1));

    const PointCloud little = parse_ply_cloud(seed("ply_cloud/little.ply"), "x");
    REQUIRE(little.offsets.size() == 2);
    CHECK(source_point(little, 1) == Vec3d(1, 1, 1));
    CHECK(little.colours.at(1) == rgb(4, 5, 6));

    const PointCloud big = parse_ply_cloud(seed("ply_cloud/big.ply"), "x");
    REQUIRE(big.offsets.size() == 1);
    CHECK(source_point(big, 0) == Vec3d(5e5, 4e6, 10));
    CHECK(big.normals.at(0) == Vec3f::UnitZ());

    CHECK(source_point(parse_ply_cloud(seed("ply_cloud/list.ply"), "x"), 0) == Vec3d(1, 2, 3));
}

TEST_CASE("PLY points: what cannot be read says why") {
    const auto error_of = [](const std::string& bytes) { return input_error([&] { parse_ply_cloud(bytes, "scan"); }); };
    CHECK_THAT(error_of(seed("ply_cloud/cut.ply")), Catch::Contains("only 20 bytes follow"));
    // Each element alone would fit.
    CHECK_THAT(
        error_of("ply\nformat binary_little_endian 1.0\nelement other 3\nproperty int a\nelement vertex 1\nproperty "
                 "float x\nproperty float y\nproperty float z\nend_header\n123456789012"),
        Catch::Contains("ends inside the data"));
    CHECK_THAT(error_of("ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nend_header\n1\n"),
               Catch::Contains("x, y and z"));
    const std::string list = seed("ply_cloud/list.ply");
    for (std::size_t size = 0; size < list.size(); size += 5)
        CHECK_THAT(error_of(list.substr(0, size)), Catch::StartsWith("scan: "));
}
