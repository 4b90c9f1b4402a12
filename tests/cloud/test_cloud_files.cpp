// Which files are taken for point clouds, and the collection of real ones.
#include "tests/cloud/cloud_checks.h"

#include <zlib.h>

using namespace splice;
using namespace splice::test;

namespace {

bool is_cloud(const std::string& bytes, const std::string& extension) {
    return is_point_cloud({"x", bytes, extension, {}});
}

}  // namespace

TEST_CASE("point clouds are told by content first, by the name's ending second") {
    CHECK(is_cloud("LASF", ".txt"));
    CHECK(is_cloud("# .PCD v0.7\n", ""));
    CHECK(is_cloud("VERSION 0.7\n", ".pcd"));
    CHECK(is_cloud("junk", ".xyz"));
    CHECK(is_cloud("1 2 3\n", ""));
    CHECK(is_cloud("# c\n7\n1,2,3\n", ".dat"));
    CHECK(is_cloud("ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nelement face 0\nend_header\n1\n2\n3\n",
                   ""));

    CHECK_FALSE(
        is_cloud("ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nelement face 1\nproperty list "
                 "uchar int vertex_indices\nend_header\n0\n1 0\n",
                 ".xyz"));
    CHECK_FALSE(is_cloud("ply\n", ".ply"));
    CHECK_FALSE(is_cloud("v 0 0 0\n", ".obj"));
    CHECK_FALSE(is_cloud("1 2 3\n", ".obj"));
    CHECK_FALSE(is_cloud("OFF\n1 0 0\n0 0 0\n", ".off"));
    CHECK_FALSE(is_cloud("", ""));
    CHECK_FALSE(is_cloud("1 2\n", ""));
}

TEST_CASE("gzipped point clouds are read as what is inside") {
    const TemporaryFolder folder;
    const std::string path = (folder / "scan.XYZ.gz").string();
    gzFile file = gzopen(path.c_str(), "wb");
    gzputs(file, "0 0 0\n1 1 1\n");
    gzclose(file);
    const SourceFile source = load_source_file(path);
    CHECK(source.extension == ".xyz");
    REQUIRE(is_point_cloud(source));
    CHECK(parse_point_cloud(source).offsets.size() == 2);
}

TEST_CASE("a cloud without a usable point is refused") {
    const auto error_of = [](const std::string& bytes) {
        return input_error([&] { parse_point_cloud({"scan", bytes, ".xyz", {}}); });
    };
    CHECK_THAT(error_of("nan 0 0\n"), Catch::Contains("none of its 1 points"));
    CHECK_THAT(input_error([] {
                   parse_point_cloud({"scan", "FIELDS x y z\nPOINTS 0\nDATA ascii\n", ".pcd", {}});
               }),
               Catch::Contains("has no points"));
}

TEST_CASE("the collection of point clouds is read whole") {
    struct Expected {
        const char* name;
        std::size_t points;
        bool normals, colours;
    };
    for (const Expected& expected :
         {Expected{"lion_takanawa_normals.ply.gz", 341989, true, true},
          Expected{"CSite1_red1-utm.ply.gz", 522674, false, false}, Expected{"ball.ply", 31374, true, false},
          Expected{"b9_training.ply", 22300, false, true}, Expected{"sphere_20k_normal.xyz", 21000, true, false},
          Expected{"kitten.xyz", 5210, true, false}, Expected{"oni.pwn", 1435, true, false},
          Expected{"poste_france.xyz", 9031, false, false}, Expected{"points_cloudcompare.xyz", 101, false, true},
          Expected{"points_agisoft.xyz", 100, false, true}}) {
        const auto path = model_file(std::string("pointclouds/") + expected.name);
        if (!path) continue;
        INFO(expected.name);
        const SourceFile file = load_source_file(*path);
        REQUIRE(is_point_cloud(file));
        const PointCloud cloud = parse_point_cloud(file);
        CHECK(cloud.offsets.size() == expected.points);
        CHECK(cloud.normals.empty() != expected.normals);
        CHECK(cloud.colours.empty() != expected.colours);
    }
}
