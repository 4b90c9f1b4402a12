#include "tests/cloud/cloud_checks.h"

using namespace splice;
using namespace splice::test;

namespace {

constexpr std::size_t kPointFormat = 104, kRecordLength = 105, kPointData = 96, kPoints = 107, kScales = 131;

}  // namespace

TEST_CASE("LAS: every point format, its colours, and the points that are withheld") {
    for (int format = 0; format <= 10; ++format) {
        INFO("format " << format);
        const PointCloud cloud = parse_las(seed("las/format" + std::to_string(format) + ".las"), "x");
        CHECK(cloud.source_points == 4);
        CHECK(cloud.withheld_points == 1);
        REQUIRE(cloud.offsets.size() == 3);
        // The seeds hold (1000 i, 500 i^2, -7 i), scale 0.001, offset (636000, 848000, 400); number 2 is withheld.
        CHECK((source_point(cloud, 2) - Vec3d(636003, 848004.5, 399.979)).norm() < 1e-6);
        const bool coloured = format == 2 || format == 3 || format == 5 || format == 7 || format == 8 || format == 10;
        REQUIRE(cloud.colours.size() == (coloured ? 3 : 0));
        // 16-bit components, since one is above 255: (40 i, 200, 65535 or 3).
        if (coloured) CHECK(cloud.colours[1] == rgb(0, 1, 255));
    }
}

TEST_CASE("LAS: colours that fill only 8 of their 16 bits are read as 8 bits") {
    std::string bytes = seed("las/format2.las");
    for (std::size_t point = 0; point < 4; ++point) {
        overwrite<std::uint16_t>(bytes, 227 + 26 * point + 20, 17);
        overwrite<std::uint16_t>(bytes, 227 + 26 * point + 24, 255);
    }
    CHECK(parse_las(bytes, "x").colours[0] == rgb(17, 200, 255));
    for (std::size_t point = 0; point < 4; ++point)
        bytes.replace(227 + 26 * point + 20, 6, 6, '\0');
    CHECK(parse_las(bytes, "x").colours.empty());  // black throughout: the writer had no colours
}

TEST_CASE("LAS: longer records than the format needs are read over") {
    std::string bytes = seed("las/format0.las").substr(0, 227);
    overwrite<std::uint16_t>(bytes, kRecordLength, 24);
    overwrite<std::uint32_t>(bytes, kPoints, 2);
    for (std::int32_t i = 0; i < 2; ++i) {
        for (int k = 0; k < 3; ++k)
            append(bytes, i * 1000);
        bytes.append(12, '\0');
    }
    const PointCloud cloud = parse_las(bytes, "x");
    REQUIRE(cloud.offsets.size() == 2);
    CHECK((source_point(cloud, 1) - Vec3d(636001, 848001, 401)).norm() < 1e-6);
}

TEST_CASE("LAS: what cannot be read says why") {
    const std::string good = seed("las/format3.las");
    const auto error_of = [&](std::size_t at, auto value) {
        std::string bytes = good;
        overwrite(bytes, at, value);
        return input_error([&] { parse_las(bytes, "scan"); });
    };
    CHECK_THAT(error_of(kPointFormat, std::uint8_t{0x83}), Catch::Contains("LAZ") && Catch::Contains("uncompress"));
    CHECK_THAT(error_of(kPointFormat, std::uint8_t{11}), Catch::Contains("point format 11"));
    CHECK_THAT(error_of(kRecordLength, std::uint16_t{33}), Catch::Contains("needs 34"));
    CHECK_THAT(error_of(kPoints, std::uint32_t{5}), Catch::Contains("5 points promised, the file has room for 4"));
    CHECK_THAT(error_of(kPointData, std::uint32_t{100}), Catch::Contains("start at byte 100"));
    CHECK_THAT(error_of(kPointData, std::uint32_t{0xffffffffu}), Catch::Contains("start at byte"));
    CHECK_THAT(error_of(25, std::uint8_t{5}), Catch::Contains("LAS version 1.5"));
    CHECK_THAT(error_of(kScales, 0.0), Catch::Contains("scale"));
    CHECK_THAT(error_of(kScales + 24, std::numeric_limits<double>::quiet_NaN()), Catch::Contains("offset"));
    for (std::size_t size = 0; size < good.size(); size += 13)
        CHECK_THAT(input_error([&] { parse_las(good.substr(0, size), "scan"); }), Catch::StartsWith("scan: "));
}

TEST_CASE("LAS: a lidar tile keeps its millimetres") {
    const auto path = model_file("pointclouds/autzen_trim.las");
    if (!path) return;
    const SourceFile file = load_source_file(*path);
    REQUIRE(is_point_cloud(file));
    const PointCloud cloud = parse_point_cloud(file);
    CHECK(cloud.offsets.size() == 110000);
    CHECK(cloud.colours.size() == 110000);
    // The file's own numbers, exact to its scale of a hundredth of a unit.
    double largest_error = 0;
    for (std::size_t point = 0; point < cloud.offsets.size(); ++point) {
        std::int32_t stored[3];
        std::uint32_t first;
        std::uint16_t record;
        double scale[3], offset[3];
        std::memcpy(&first, &file.bytes[kPointData], sizeof first);
        std::memcpy(&record, &file.bytes[kRecordLength], sizeof record);
        std::memcpy(scale, &file.bytes[kScales], sizeof scale);
        std::memcpy(offset, &file.bytes[kScales + 24], sizeof offset);
        std::memcpy(stored, &file.bytes[first + point * record], sizeof stored);
        for (int k = 0; k < 3; ++k)
            largest_error =
                std::max(largest_error, std::abs(source_point(cloud, point)[k] - (stored[k] * scale[k] + offset[k])));
    }
    CHECK(largest_error < 1e-4);
}
