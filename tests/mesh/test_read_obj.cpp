#include "tests/mesh/mesh_checks.h"
#include "tests/support/test_files.h"

#include <cmath>
#include <fstream>

using namespace splice;
using namespace splice::test;

namespace {

SourceMesh obj(std::string_view text) {
    return parse_obj(text, "test.obj", {});
}

void write(const std::filesystem::path& path, const std::string& text) {
    std::ofstream(path, std::ios::binary) << text;
}

constexpr const char* kThreeVertices = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";

}  // namespace

TEST_CASE("OBJ polygons keep their corners, indices are 1-based") {
    const SourceMesh mesh = obj("v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0.5 2 0\nf 1 2 3 4\nf 4 3 5\n");
    REQUIRE(polygons(mesh) == 2);
    CHECK(polygon(mesh, 0) == Indices{0, 1, 2, 3});
    CHECK(polygon(mesh, 1) == Indices{3, 2, 4});
}

TEST_CASE("OBJ coordinates keep double precision, as map coordinates need") {
    const SourceMesh mesh = obj("v 636001.76 5648301.125 406.26\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    CHECK(mesh.positions[0].x() == Approx(636001.76).epsilon(1e-14));
    CHECK(mesh.positions[0].y() == Approx(5648301.125).epsilon(1e-14));
}

TEST_CASE("OBJ negative indices count back from where they stand") {
    const SourceMesh mesh =
        obj(std::string(kThreeVertices) + "vt 0 0\nvt 1 0\nvt 0.5 1\nf -3/-3 -2/-2 -1/-1\nv 9 9 9\nf -4 -3 -1\n");
    CHECK(polygon(mesh, 0) == Indices{0, 1, 2});
    CHECK(polygon(mesh, 1) == Indices{0, 1, 3});
    REQUIRE(mesh.corner_uvs.size() == 6);
    CHECK(mesh.corner_uvs[2] == Vec2f(0.5f, 0));
}

TEST_CASE("OBJ faces may come before their vertices") {
    CHECK(polygon(obj("f 1 2 3\nv 0 0 0\nv 1 0 0\nv 0 1 0\n"), 0) == Indices{0, 1, 2});
}

TEST_CASE("OBJ line ends: CRLF, lone CR, none at the end, byte order mark, tabs, continuation") {
    for (const char* text :
         {"v 0 0 0\r\nv 1 0 0\r\nv 0 1 0\r\nf 1 2 3\r\n", "v 0 0 0\rv 1 0 0\rv 0 1 0\rf 1 2 3",
          "\xEF\xBB\xBFv\t0\t0\t0\nv 1  0 0\nv 0 1 0  \nf  1\t2 3", "v 0 0 0\nv 1 0 0\nv 0 1 \\\n0\nf 1 \\\r\n2 3\n"}) {
        const SourceMesh mesh = obj(text);
        REQUIRE(polygons(mesh) == 1);
        CHECK(polygon(mesh, 0) == Indices{0, 1, 2});
        CHECK(mesh.positions[1] == Vec3d(1, 0, 0));
    }
}

TEST_CASE("OBJ vertex colours, as fractions or bytes, a weight is no colour") {
    const SourceMesh fractions = obj("v 0 0 0 1 0 0.5\nv 1 0 0 0 1 0\nv 0 1 0\nf 1 2 3\n");
    REQUIRE(fractions.corner_colours.size() == 3);
    CHECK(fractions.corner_colours[0] == 0xff8000ffu);
    CHECK(fractions.corner_colours[1] == 0xff00ff00u);
    CHECK(fractions.corner_colours[2] == kWhite);
    const SourceMesh bytes = obj("v 0 0 0 255 0 51\nv 1 0 0 0 255 0\nv 0 1 0 0 0 0\nf 1 2 3\n");
    CHECK(bytes.corner_colours[0] == 0xff3300ffu);
    CHECK(obj("v 0 0 0 1\nv 1 0 0 1\nv 0 1 0 1\nf 1 2 3\n").corner_colours.empty());
    CHECK(obj("v 0 0 0 nan nan nan\nv 1 0 0 nan 0 0\nv 0 1 0 0 0 0\nf 1 2 3\n").corner_colours[0] == kWhite);
}

TEST_CASE("OBJ coordinates that are no numbers do not become zero") {
    const SourceMesh mesh = obj("v nan 0 0\nv 1.#INF 0 0\nv 1e999 0 0\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 4 5 6\nf 1 2 3\n");
    for (std::size_t v = 0; v < 3; ++v)
        CHECK_FALSE(mesh.positions[v].allFinite());
    CHECK(mesh.positions[4] == Vec3d(1, 0, 0));
}

TEST_CASE("OBJ numbers in every usual spelling") {
    const SourceMesh mesh = obj("v .5 +1. -.25e1\nv 1E2 1e-2 1e+2\nv 0 0 0\nf 1 2 3\n");
    CHECK(mesh.positions[0] == Vec3d(0.5, 1, -2.5));
    CHECK(mesh.positions[1].x() == 100);
    CHECK(mesh.positions[1].y() == Approx(0.01));
}

TEST_CASE("OBJ indices that no vertex can have stay out of range instead of wrapping") {
    const SourceMesh mesh =
        obj(std::string(kThreeVertices) +
            "f 1 2 3\nf 1 2 99\nf 1 2 -99\nf 0 1 2\nf 1 2 4294967297\nf 1 2 18446744073709551617\n");
    REQUIRE(polygons(mesh) == 6);
    for (std::size_t p = 1; p < 6; ++p) {
        bool outside = false;
        for (const std::uint32_t index : polygon(mesh, p))
            outside |= index >= 3;
        CHECK(outside);
    }
}

TEST_CASE("OBJ statements that are no geometry are left out: tags, groups, lines, points, curves") {
    const SourceMesh mesh =
        obj(std::string(kThreeVertices) +
            "t crease 2/1/0 1 2 3.0\ng a b\no name\ns 1\nl 1 2\np 1\nvp 0 0\ncurv 0 1 1 2\nf 1 2 3\n");
    CHECK(polygons(mesh) == 1);
}

TEST_CASE("OBJ file without one usable face names the line of the first") {
    const std::string message = input_error([] { obj("v 0 0 0\n\nf 1 2\nf 1 2 3\n"); });
    CHECK_THAT(message, Catch::Contains("test.obj: line 3"));
}

TEST_CASE("OBJ materials: colours, textures with blanks in their names, first definition counts") {
    const TemporaryFolder folder;
    write(folder / "my scene.mtl",
          "newmtl\tred wall \nKd 1 0 0\nnewmtl colourless\nmap_Kd two by one.ppm\nnewmtl plain\nKd 0 1 0.5\nmap_Kd -s "
          "1 1 1 two by one.ppm\nnewmtl plain\nKd 0 0 "
          "0\n");
    write(folder / "two by one.ppm", std::string("P6\n2 1\n255\n") + "\xff" + std::string(4, '\0') + "\xff");
    write(folder / "scene.obj",
          std::string(kThreeVertices) +
              "mtllib my scene.mtl\nvt 0 0\nvt 1 0\nvt 0 1\nf 1/1 2/2 3/3\nusemtl red wall\nf 3/3 2/2 1/1\n"
              "usemtl plain\nf 1/1 3/3 2/2\nusemtl unknown\nf 1/1 2/2 3/3\n"
              "usemtl colourless\nf 1/1 2/2 3/3\n");
    const SourceMesh mesh = read_mesh_file(folder / "scene.obj");
    REQUIRE(mesh.polygon_material.size() == 5);
    const auto material = [&](std::size_t p) { return mesh.materials.at(mesh.polygon_material[p]); };
    CHECK(material(0).diffuse == kWhite);
    CHECK(material(1).diffuse == 0xff0000ffu);
    CHECK(material(2).diffuse == 0xff80ff00u);
    CHECK(material(3).diffuse == kWhite);
    CHECK(material(4).diffuse == kWhite);
    CHECK(material(4).image == material(2).image);
    REQUIRE(material(2).image == 0);
    REQUIRE(mesh.images.size() == 1);
    CHECK(mesh.images[0].width == 2);
    CHECK(mesh.images[0].rgba == std::vector<std::uint8_t>{255, 0, 0, 255, 0, 0, 255, 255});
    CHECK(mesh.corner_uvs[2] == Vec2f(0, 0));  // v grows downwards
    REQUIRE(mesh.warnings.size() == 1);
    CHECK_THAT(mesh.warnings[0], Catch::Contains("unknown"));
}

TEST_CASE("OBJ files that leave the mesh's folder are refused, missing ones reported, the mesh is read all the same") {
    const TemporaryFolder folder;
    std::filesystem::create_directory(folder / "inner");
    write(folder / "outside.mtl", "newmtl m\nKd 0 0 0\n");
    std::filesystem::create_symlink(folder / "outside.mtl", folder / "inner" / "link.mtl");
    const std::string absolute = (folder / "outside.mtl").string();
    for (const std::string& library : {std::string("../outside.mtl"), std::string("..\\outside.mtl"), absolute,
                                       std::string("link.mtl"), std::string("a/../../outside.mtl")}) {
        write(folder / "inner" / "mesh.obj",
              std::string(kThreeVertices) + "mtllib " + library + "\nusemtl m\nf 1 2 3\n");
        const SourceMesh mesh = read_mesh_file(folder / "inner" / "mesh.obj");
        REQUIRE(!mesh.warnings.empty());
        CHECK_THAT(mesh.warnings[0], Catch::Contains("leaves the folder"));
        CHECK(mesh.materials.at(mesh.polygon_material[0]).diffuse == kWhite);
    }
    write(folder / "mesh.obj", std::string(kThreeVertices) + "mtllib nowhere.mtl\nf 1 2 3\n");
    CHECK_THAT(read_mesh_file(folder / "mesh.obj").warnings.at(0), Catch::Contains("nowhere.mtl\" not found"));
}

TEST_CASE("OBJ normals are looked up per corner, bad references leave them missing") {
    const SourceMesh mesh = obj(std::string(kThreeVertices) + "vn 0 0 1\nvn 1 0 0\nf 1//1 2//2 3//7\n");
    REQUIRE(mesh.corner_normals.size() == 3);
    CHECK(mesh.corner_normals[0] == Vec3f(0, 0, 1));
    CHECK(mesh.corner_normals[1] == Vec3f(1, 0, 0));
    CHECK(mesh.corner_normals[2] == Vec3f(0, 0, 0));
}

TEST_CASE("OBJ warnings do not grow with the file") {
    std::string text = kThreeVertices;
    for (int i = 0; i < 1000; ++i)
        text += "usemtl m" + std::to_string(i) + "\nf 1 2 3\n";
    const SourceMesh mesh = obj(text);
    CHECK(mesh.warnings.size() == 21);
    CHECK(mesh.materials.size() == 1);
    const SourceMesh escape = obj(std::string(kThreeVertices) + "usemtl \x1b[31m\x07\nf 1 2 3\n");
    for (const char c : escape.warnings.at(0))
        CHECK(c >= ' ');
}
