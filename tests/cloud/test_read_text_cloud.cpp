#include "tests/cloud/cloud_checks.h"

#include <tbb/global_control.h>

using namespace splice;
using namespace splice::test;

namespace {

PointCloud text(const std::string& bytes, const std::string& extension = ".xyz") {
    return parse_text_cloud(bytes, extension, "scan");
}

}  // namespace

TEST_CASE("text: three numbers are a position, unit vectors normals, whole numbers up to 255 colours") {
    CHECK(text("0 0 0\n1 2 3\n").offsets.at(1) == Vec3f(1, 2, 3));
    CHECK(text("0 0 0 0 0 1\n1 0 0 0.6 0.8 0\n").normals.at(1) == Vec3f(0.6f, 0.8f, 0));
    CHECK(text("0 0 0 0 0 1\n1 0 0 0.6 0.8 0\n").colours.empty());
    CHECK(text("0 0 0 255 0 7\n").colours.at(0) == rgb(255, 0, 7));
    CHECK(text("0 0 0 255.0 0.0 7.0 255.0\n").colours.at(0) == rgb(255, 0, 7));
    CHECK(text("0 0 0 1 0.5 0\n1 1 1 0.2 0.2 0.2\n").colours.at(0) == rgb(255, 128, 0));
    const PointCloud both = text("0 0 0 10 20 30 0 0 1\n");
    CHECK(both.colours.at(0) == rgb(10, 20, 30));
    CHECK(both.normals.at(0) == Vec3f::UnitZ());
    const PointCloud scalars = text("0 0 0 17.5 -3\n1 1 1 2.5 4\n");
    CHECK(scalars.colours.empty());
    CHECK(scalars.normals.empty());
}

TEST_CASE("text: PTS has a count and the intensity before the colour") {
    const PointCloud cloud = text(seed("xyz/count.pts"), ".pts");
    CHECK(cloud.offsets.size() == 3);
    CHECK(cloud.colours == std::vector<std::uint32_t>{rgb(255, 0, 0), rgb(0, 255, 0), rgb(0, 0, 255)});
    CHECK(text("1\n0 0 0 5\n1\n1 1 1 6\n", ".pts").offsets.size() == 2);  // two scans, each with its count
}

TEST_CASE("text: PWN with a normal a line, and with all normals after all points") {
    CHECK(text("0 0 0 0 0 1\n", ".pwn").normals.size() == 1);
    const PointCloud cloud = text(seed("xyz/two_blocks.pwn"), ".pwn");
    CHECK(cloud.offsets.size() == 2);
    CHECK(cloud.normals == std::vector<Vec3f>{Vec3f::UnitZ(), Vec3f::UnitY()});
}

TEST_CASE("text: headings, comments, separators, line ends, survey coordinates") {
    CHECK(text(seed("xyz/colours.csv"), ".csv").colours.at(1) == rgb(3, 4, 5));
    CHECK(text(seed("xyz/crlf.xyz")).offsets.size() == 2);
    CHECK(text("\xEF\xBB\xBF"
               "0 0 0\n")
              .offsets.size() == 1);
    const PointCloud cloud = text(seed("xyz/survey.xyz"));
    REQUIRE(cloud.offsets.size() == 2);
    CHECK((source_point(cloud, 1) - Vec3d(665187.404645, 5648349.776039, 244.857091)).norm() < 1e-6);
}

TEST_CASE("text: points that are not finite or too far are dropped and counted") {
    const PointCloud cloud = text("0 0 0\nnan 0 0\n0 inf 0\n1e300 0 0\n1 1 1\n");
    CHECK(cloud.source_points == 5);
    CHECK(cloud.nonfinite_points == 3);
    CHECK(cloud.offsets.size() == 2);
    CHECK(text("0 0 0 nan nan nan\n1 0 0 0 0 1\n").normals.at(0) == Vec3f::Zero());
}

TEST_CASE("text: a line that has no point is refused by its number") {
    const auto error_of = [](const std::string& bytes) { return input_error([&] { text(bytes); }); };
    CHECK_THAT(error_of("# c\n0 0 0 1 1 1\n1 2\n"), Catch::Contains("scan: line 3: expected 6 numbers, found \"1 2\""));
    CHECK_THAT(error_of("0 0 0\n1 x 0\n"), Catch::Contains("line 2"));
    CHECK_THAT(error_of("heading\n"), Catch::Contains("no line with the three coordinates"));
    CHECK_THAT(error_of(""), Catch::Contains("no line with the three coordinates"));
}

TEST_CASE("text: long files are read in pieces, the same for any number of threads") {
    std::string bytes;
    for (int i = 0; i < 300000; ++i)
        bytes += std::to_string(i) + " " + std::to_string(i % 7) + " 0.5\n";
    REQUIRE(bytes.size() > 3u << 20);
    const PointCloud cloud = text(bytes);
    REQUIRE(cloud.offsets.size() == 300000);
    for (std::size_t i = 0; i < cloud.offsets.size(); i += 997)
        CHECK(source_point(cloud, i) == Vec3d(static_cast<double>(i), static_cast<double>(i % 7), 0.5));
    const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
    CHECK(text(bytes).offsets == cloud.offsets);
    bytes += "oops\n";
    CHECK_THAT(input_error([&] { text(bytes); }), Catch::Contains("line 300001"));
}
