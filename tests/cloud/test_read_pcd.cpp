#include "preprocess/cloud/lzf.h"
#include "tests/cloud/cloud_checks.h"

using namespace splice;
using namespace splice::test;

TEST_CASE("PCD: ascii, binary and compressed hold the same points") {
    for (const char* name : {"pcd/ascii.pcd", "pcd/binary.pcd", "pcd/compressed.pcd"}) {
        INFO(name);
        const PointCloud cloud = parse_pcd(seed(name), "x");
        CHECK(cloud.source_points == 4);
        CHECK(cloud.nonfinite_points == 1);
        REQUIRE(cloud.offsets.size() == 3);
        CHECK(source_point(cloud, 1) == Vec3d(0, 1, 0.5));
        CHECK(source_point(cloud, 2) == Vec3d(1, 1, 0.25));
    }
    CHECK(parse_pcd(seed("pcd/compressed_copy.pcd"), "x").offsets == std::vector<Vec3f>(4, Vec3f::Zero()));
}

TEST_CASE("PCD: packed colours and normals") {
    CHECK(parse_pcd(seed("pcd/binary.pcd"), "x").colours.at(0) == rgb(0x20, 0x40, 0x60));
    CHECK(parse_pcd(seed("pcd/binary_padded.pcd"), "x").colours.at(0) == rgb(0xff, 0x80, 0));
    const PointCloud ascii = parse_pcd(seed("pcd/ascii_rgb.pcd"), "x");
    CHECK(ascii.colours == std::vector<std::uint32_t>{rgb(255, 0, 0), rgb(0, 0, 255)});
    CHECK(ascii.normals == std::vector<Vec3f>(2, Vec3f::UnitZ()));
    // Written as the float whose bits are 0x00ff0000.
    CHECK(parse_pcd(seed("pcd/ascii_float_rgb.pcd"), "x").colours.at(0) == rgb(0xff, 0, 0));
}

TEST_CASE("LZF: copies may overlap what they write, damage is found") {
    using namespace std::string_literals;
    CHECK(decompress_lzf("\0a\x20\0"s, 4) == "aaaa");              // a, then three more from one back
    CHECK(decompress_lzf("\1ab\xe0\1\1"s, 12) == "abababababab");  // the long form: 7 + 1 + 2
    CHECK_FALSE(decompress_lzf("\0a\x20\0"s, 5));                  // stands for fewer
    CHECK_FALSE(decompress_lzf("\0a\x20\0"s, 3));                  // for more
    CHECK_FALSE(decompress_lzf("\0a\x20\1"s, 4));                  // reaches before the start
    CHECK_FALSE(decompress_lzf("\5abc"s, 6));                      // ends inside a run
    CHECK_FALSE(decompress_lzf("\0a\xe0"s, 12));                   // ends inside a copy
    CHECK_FALSE(decompress_lzf("\0a\x20"s, 4));
    CHECK_FALSE(decompress_lzf("\0a"s, std::size_t{1} << 60));  // cannot be: not even tried
}

TEST_CASE("PCD: what cannot be read says why") {
    const auto error_of = [](const std::string& bytes) { return input_error([&] { parse_pcd(bytes, "scan"); }); };
    CHECK_THAT(error_of(seed("pcd/too_many.pcd")), Catch::Contains("4294967295 points of 12 bytes promised"));
    CHECK_THAT(error_of(seed("pcd/bomb.pcd")), Catch::Contains("damaged"));
    CHECK_THAT(error_of(seed("pcd/no_data.pcd")), Catch::Contains("no \"DATA\""));
    CHECK_THAT(error_of("FIELDS x y\nSIZE 4 4\nTYPE F F\nPOINTS 1\nDATA ascii\n1 2\n"), Catch::Contains("x, y and z"));
    CHECK_THAT(error_of("FIELDS x y z\nSIZE 4 3 4\n"), Catch::Contains("line 2") && Catch::Contains("3 bytes"));
    CHECK_THAT(error_of("FIELDS x y z\nPOINTS 2\nDATA ascii\n1 2 3\n"), Catch::Contains("2 points promised, 1 found"));
    CHECK_THAT(error_of("FIELDS x y z\nPOINTS 1\nDATA ascii\n1 a 3\n"), Catch::Contains("line 4"));
    CHECK_THAT(error_of("FIELDS x y z\nPOINTS 1\nDATA zstd\n"), Catch::Contains("unknown data"));
    CHECK_THAT(error_of("FIELDS x y z\nCOUNT 1 1 4294967295\nPOINTS 1\nDATA binary\n"), Catch::Contains("too many"));
    CHECK_THAT(error_of("FIELDS x y z\nDATA binary\n"), Catch::Contains("how many"));
    const std::string compressed = seed("pcd/compressed.pcd");
    for (std::size_t size = 0; size < compressed.size(); size += 7)
        CHECK_THAT(error_of(compressed.substr(0, size)), Catch::StartsWith("scan: "));
}

TEST_CASE("PCD: real files") {
    const auto kinect = model_file("pointclouds/region_growing_rgb_tutorial.pcd");
    if (!kinect) return;
    const PointCloud cloud = parse_point_cloud(load_source_file(*kinect));
    CHECK(cloud.source_points == 307200);
    CHECK(cloud.nonfinite_points == 47353);
    CHECK(cloud.colours.size() == 307200 - 47353);
    const auto street = model_file("pointclouds/min_cut_segmentation_tutorial.pcd");
    if (street) CHECK(parse_point_cloud(load_source_file(*street)).offsets.size() == 9311);
}
