#include "tests/mesh/mesh_checks.h"
#include "tests/support/test_files.h"

#include <bit>
#include <cstring>
#include <fstream>

using namespace splice;
using namespace splice::test;

namespace {

SourceMesh ply(const std::string& bytes) {
    return parse_ply(bytes, "test.ply", {});
}

/// Appends `value` in the given byte order.
template <class Value>
void put(std::string& bytes, Value value, std::endian order) {
    char raw[sizeof value];
    std::memcpy(raw, &value, sizeof value);
    if (order != std::endian::native) std::reverse(raw, raw + sizeof raw);
    bytes.append(raw, sizeof raw);
}

const std::string kAsciiVertices = "0 0 0\n1 0 0\n0 1 0\n";

std::string ascii_header(const std::string& elements) {
    return "ply\nformat ascii 1.0\n" + elements + "end_header\n";
}

const std::string kXyz = "property float x\nproperty float y\nproperty float z\n";

}  // namespace

TEST_CASE("PLY ascii with polygons") {
    const SourceMesh mesh =
        ply(ascii_header("element vertex 4\n" + kXyz + "element face 2\nproperty list uchar int vertex_indices\n") +
            "0 0 0\n1 0 0\n1 1 0\n0 1 0.5\n4 0 1 2 3\n3 0 1 2\n");
    REQUIRE(polygons(mesh) == 2);
    CHECK(polygon(mesh, 0) == Indices{0, 1, 2, 3});
    CHECK(polygon(mesh, 1) == Indices{0, 1, 2});
    CHECK(mesh.positions[3] == Vec3d(0, 1, 0.5));
}

TEST_CASE("PLY binary in both byte orders, with properties of every type and unknown elements between") {
    for (const std::endian order : {std::endian::little, std::endian::big}) {
        std::string bytes =
            std::string("ply\nformat ") +
            (order == std::endian::little ? "binary_little_endian" : "binary_big_endian") +
            " 1.0\nelement camera 1\nproperty double a\nproperty list ushort short b\nelement vertex 3\n"
            "property char q\nproperty double x\nproperty float y\nproperty short z\nproperty ushort red\n"
            "property uchar green\nproperty float blue\nelement face 1\nproperty int8 skipped\n"
            "property list int32 uint32 vertex_index\nproperty uint8 flag\nend_header\n";
        put(bytes, 3.25, order);
        put<std::uint16_t>(bytes, 2, order);
        put<std::int16_t>(bytes, -1, order);
        put<std::int16_t>(bytes, -2, order);
        for (int v = 0; v < 3; ++v) {
            put<std::int8_t>(bytes, -5, order);
            put(bytes, 636001.76 + v, order);
            put(bytes, 2.5f * static_cast<float>(v), order);
            put<std::int16_t>(bytes, static_cast<std::int16_t>(-300 * v * v), order);
            put<std::uint16_t>(bytes, 65535, order);
            put<std::uint8_t>(bytes, 51, order);
            put(bytes, 0.0f, order);
        }
        put<std::int8_t>(bytes, 1, order);
        put<std::int32_t>(bytes, 3, order);
        for (const std::uint32_t index : {2u, 1u, 0u})
            put(bytes, index, order);
        put<std::uint8_t>(bytes, 7, order);

        const SourceMesh mesh = ply(bytes);
        REQUIRE(polygons(mesh) == 1);
        CHECK(polygon(mesh, 0) == Indices{2, 1, 0});
        CHECK(mesh.positions[2] == Vec3d(636003.76, 5, -1200));
        REQUIRE(mesh.corner_colours.size() == 3);
        CHECK(mesh.corner_colours[0] == 0xff0033ffu);
    }
}

TEST_CASE("PLY vertex normals, uvs and colours become corner attributes") {
    const SourceMesh mesh =
        ply(ascii_header("element vertex 3\n" + kXyz +
                         "property float nx\nproperty float ny\nproperty float nz\nproperty float s\n"
                         "property float t\nproperty uchar red\nproperty uchar green\nproperty uchar blue\n"
                         "element face 1\nproperty list uchar int vertex_indices\n") +
            "0 0 0 0 0 1 0 0.25 255 0 0\n1 0 0 0 1 0 1 0 0 255 0\n0 1 0 1 0 0 0.5 1 0 0 255\n3 2 0 1\n");
    REQUIRE(mesh.corner_normals.size() == 3);
    CHECK(mesh.corner_normals[0] == Vec3f(1, 0, 0));
    CHECK(mesh.corner_uvs[1] == Vec2f(0, 0.75f));
    CHECK(mesh.corner_colours[2] == 0xff00ff00u);
}

TEST_CASE("PLY face colours serve where vertices have none") {
    const SourceMesh mesh =
        ply(ascii_header("element vertex 3\n" + kXyz +
                         "element face 1\nproperty list uchar int vertex_indices\nproperty uchar red\n"
                         "property uchar green\nproperty uchar blue\n") +
            kAsciiVertices + "3 0 1 2 0 0 255\n");
    CHECK(mesh.corner_colours == std::vector<std::uint32_t>(3, 0xffff0000u));
}

TEST_CASE("PLY texture coordinates per face, with the image that a comment names") {
    const TemporaryFolder folder;
    std::ofstream(folder / "one pixel.ppm", std::ios::binary) << "P6\n1 1\n255\n\x10\x20\x30";
    std::ofstream(folder / "mesh.ply", std::ios::binary)
        << "ply\nformat ascii 1.0\ncomment TextureFile   one pixel.ppm \nelement vertex 3\n" + kXyz +
               "element face 2\nproperty list uchar int vertex_indices\nproperty list uchar float "
               "texcoord\nend_header\n" +
               kAsciiVertices + "3 0 1 2 0\n3 2 1 0 6 0 0 1 0 0.5 1\n";
    const SourceMesh mesh = read_mesh_file(folder / "mesh.ply");
    REQUIRE(mesh.corner_uvs.size() == 6);
    CHECK(mesh.corner_uvs[0] == Vec2f(0, 0));
    CHECK(mesh.corner_uvs[3] == Vec2f(0, 1));
    CHECK(mesh.corner_uvs[5] == Vec2f(0.5f, 0));
    REQUIRE(mesh.images.size() == 1);
    CHECK(mesh.images[0].rgba == std::vector<std::uint8_t>{0x10, 0x20, 0x30, 255});
    CHECK(mesh.materials.at(0).image == 0);
}

TEST_CASE("PLY triangle strips alternate their winding, -1 starts afresh, stitches are no triangles") {
    const SourceMesh mesh =
        ply(ascii_header("element vertex 5\n" + kXyz + "element tristrips 1\nproperty list int int vertex_indices\n") +
            kAsciiVertices + "1 1 0\n2 2 0\n12 0 1 2 3 -1 1 3 3 4 2 -1 0\n");
    REQUIRE(polygons(mesh) == 3);
    CHECK(polygon(mesh, 0) == Indices{0, 1, 2});
    CHECK(polygon(mesh, 1) == Indices{2, 1, 3});
    CHECK(polygon(mesh, 2) == Indices{3, 4, 2});
}

TEST_CASE("PLY header traps: CRLF, end_header inside a comment, elements without properties") {
    const std::string body =
        "ply\r\nformat ascii 1.0\r\ncomment end_header\r\nobj_info x\r\nelement nothing 4000000000\r\n"
        "element vertex 3\r\nproperty float x\r\nproperty float y\r\nproperty float z\r\nelement face 1\r\n"
        "property list uchar int vertex_indices\r\nend_header\r\n0 0 0\r\n1 0 0\r\n0 1 0\r\n3 0 1 2\r\n";
    CHECK(polygons(ply(body)) == 1);
}

TEST_CASE("PLY indices outside the vertices are kept for repair to drop") {
    const SourceMesh mesh =
        ply(ascii_header("element vertex 3\n" + kXyz + "element face 3\nproperty list uchar int vertex_indices\n") +
            kAsciiVertices + "3 0 1 2\n3 0 1 7\n3 0 1 -1\n");
    RepairReport report;
    CHECK(repaired(mesh, &report).triangles.size() == 1);
    CHECK(report.invalid_polygons == 2);
}

TEST_CASE("PLY errors name the line or byte and what was expected") {
    const auto message = [](const std::string& bytes) { return input_error([&] { ply(bytes); }); };
    CHECK_THAT(message("plx\n"), Catch::Contains("line 1") && Catch::Contains("\"ply\""));
    CHECK_THAT(message("ply\nformat ascii 1.0\nelement vertex -5\nend_header\n"), Catch::Contains("line 3"));
    CHECK_THAT(message("ply\nformat binary_middle_endian 1.0\nend_header\n"), Catch::Contains("line 2"));
    CHECK_THAT(message("ply\nformat ascii 1.0\nelement vertex 3\nproperty quad x\nend_header\n"),
               Catch::Contains("line 4"));
    CHECK_THAT(message("ply\nformat ascii 1.0\nproperty float x\nend_header\n"), Catch::Contains("before any element"));
    CHECK_THAT(message("ply\nformat ascii 1.0\nelement vertex 3\n"), Catch::Contains("end_header"));
    CHECK_THAT(message("ply\nend_header\n"), Catch::Contains("format"));
    CHECK_THAT(message(ascii_header("element vertex 4294967295\n" + kXyz) + "0 0 0\n"),
               Catch::Contains("line 3") && Catch::Contains("4294967295"));
    CHECK_THAT(message(ascii_header("element vertex 3\nproperty float x\nproperty float y\n") + "0 0\n0 0\n0 0\n"),
               Catch::Contains("line 3") && Catch::Contains("x, y and z"));
    CHECK_THAT(message(ascii_header("element vertex 3\n" + kXyz) + "0 0 0\n1 0 zero\n0 1 0\n"),
               Catch::Contains("line 9"));
    CHECK_THAT(message(ascii_header("element vertex 3\n" + kXyz) + "0000000 0 0\n1000000 0 0\n0\n"),
               Catch::Contains("file ends"));
    CHECK_THAT(
        message(ascii_header("element vertex 3\n" + kXyz + "element face 1\nproperty list uchar int vertex_indices\n") +
                kAsciiVertices + "200 0 1 2\n"),
        Catch::Contains("impossible length"));
}

TEST_CASE("PLY binary files that are cut name the byte") {
    std::string bytes = "ply\nformat binary_little_endian 1.0\nelement vertex 2\n" + kXyz +
                        "element face 1\nproperty list uchar int vertex_indices\nend_header\n";
    for (int i = 0; i < 6; ++i)
        put(bytes, 1.0f, std::endian::little);
    put<std::uint8_t>(bytes, 3, std::endian::little);
    put<std::int32_t>(bytes, 0, std::endian::little);
    CHECK_THAT(input_error([&] { ply(bytes); }), Catch::Contains("byte " + std::to_string(bytes.size() - 4)));
}
