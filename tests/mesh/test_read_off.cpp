#include "tests/mesh/mesh_checks.h"

using namespace splice;
using namespace splice::test;

namespace {

SourceMesh off(const std::string& text) {
    return parse_off(text, "test.off");
}

const std::string kTriangle = "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";

}  // namespace

TEST_CASE("OFF with comments, blank lines, CRLF, a glued header and a missing edge count") {
    for (const std::string& text : std::vector<std::string>{
             "OFF\n3 1 0\n" + kTriangle, "OFF 3 1 0\n" + kTriangle, "\t  OFF3 1 0 # or nah\n" + kTriangle,
             "# first\n\nOFF # c\n# counts\n3 1 # two only\n0 0 0 # a\n\n1 0 0\n# b\n0 1 0\n3 0 1 2 # face\n# end\n",
             std::string("OFF\r\n3 1 0\r\n0 0 0\r\n1 0 0\r\n0 1 0\r\n3 0 1 2\r\n"),
             std::string("OFF\n3 1 0\n0 0 0 1 0 0 0 1 0 3 0 1 2")}) {
        const SourceMesh mesh = off(text);
        REQUIRE(polygons(mesh) == 1);
        CHECK(polygon(mesh, 0) == Indices{0, 1, 2});
        CHECK(mesh.positions[2] == Vec3d(0, 1, 0));
    }
}

TEST_CASE("OFF polygons and face colours, whole or fractional, with or without alpha") {
    const SourceMesh mesh =
        off("OFF\n4 3 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3 255 0 0\n3 0 1 2 0.0 1.0 0.0 0.75\n3 0 2 3\n");
    REQUIRE(polygons(mesh) == 3);
    CHECK(polygon(mesh, 0) == Indices{0, 1, 2, 3});
    CHECK(mesh.corner_colours[0] == 0xff0000ffu);
    CHECK(mesh.corner_colours[4] == 0xff00ff00u);
    CHECK(mesh.corner_colours[7] == kWhite);
}

TEST_CASE("OFF vertex colours: RGBA and RGB") {
    CHECK(off("COFF\n3 1 0\n0 0 0 255 0 0 255\n1 0 0 0 255 0 255\n0 1 0 0 0 255 255\n3 0 1 2\n").corner_colours ==
          std::vector<std::uint32_t>{0xff0000ffu, 0xff00ff00u, 0xffff0000u});
    CHECK(off("COFF\n3 1 0\n0 0 0 255 0 0\n1 0 0 0 255 0\n0 1 0 0 0 255\n3 0 1 2\n").corner_colours ==
          std::vector<std::uint32_t>{0xff0000ffu, 0xff00ff00u, 0xffff0000u});
}

TEST_CASE("OFF prefixes: normals, texture coordinates, all together, homogeneous") {
    const SourceMesh mesh =
        off("STCNOFF\n3 1 0\n0 0 0 0 0 1 1 0 0 1 0.25 1\n1 0 0 0 0 1 0 1 0 1 0 0\n0 1 0 0 1 0 0 0 1 1 1 0\n3 0 1 2\n");
    REQUIRE(mesh.corner_normals.size() == 3);
    CHECK(mesh.corner_normals[2] == Vec3f(0, 1, 0));
    CHECK(mesh.corner_uvs[0] == Vec2f(0.25f, 0));
    CHECK(mesh.corner_colours[1] == 0xff00ff00u);
    CHECK(off("4OFF\n3 1 0\n0 0 0 2\n2 0 0 2\n0 4 0 2\n3 0 1 2\n").positions[2] == Vec3d(0, 2, 0));
}

TEST_CASE("OFF decoration after plain vertices is left out") {
    const SourceMesh mesh = off("OFF\n3 1 0\n0 0 0 200 100 50\n1 0 0 200 100 50\n0 1 0 200 100 50\n3 0 1 2\n");
    CHECK(mesh.positions[1] == Vec3d(1, 0, 0));
    CHECK(polygon(mesh, 0) == Indices{0, 1, 2});
}

TEST_CASE("OFF errors name the line and what was expected") {
    const auto message = [](const std::string& text) { return input_error([&] { off(text); }); };
    CHECK_THAT(message("OFX\n"), Catch::Contains("line 1") && Catch::Contains("OFF header"));
    CHECK_THAT(message("OFF\n4000000000 1 0\n" + kTriangle), Catch::Contains("impossible number of vertices"));
    CHECK_THAT(message("OFF\n3 -1 0\n" + kTriangle), Catch::Contains("impossible number of faces"));
    CHECK_THAT(message("OFF\n3 2 0\n" + kTriangle), Catch::Contains("file ends"));
    CHECK_THAT(message("OFF\n3 1 0\n0 0 0\n1 0 zero\n0 1 0\n3 0 1 2\n"), Catch::Contains("line 4"));
    CHECK_THAT(message("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n4000000000 0 1 2\n"),
               Catch::Contains("line 6") && Catch::Contains("impossible number of corners"));
    CHECK_THAT(message("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n2.5 0 1 2\n"),
               Catch::Contains("line 6") && Catch::Contains("impossible number of corners"));
    CHECK_THAT(message("OFF\n3 2 0\n0 0 0\n1 0 0\n0 1 0\n7 0 1 2\n3 0 1\n\n\n"),
               Catch::Contains("line 6") && Catch::Contains("7 corners, but the file ends after 6"));
    CHECK_THAT(message("OFF BINARY\n"), Catch::Contains("binary OFF"));
    CHECK_THAT(message("nOFF\n5\n3 1 0\n"), Catch::Contains("three-dimensional"));
}
