#include "tests/mesh/mesh_checks.h"
#include "tests/support/test_files.h"

#include <fstream>

using namespace splice;
using namespace splice::test;

namespace {

SourceMesh smf(const std::string& text) {
    return parse_smf(text, "test.smf", {});
}

const std::string kVertices = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";

void check_near(const Vec3d& a, const Vec3d& b) {
    CHECK((a - b).norm() < 1e-12);
}

}  // namespace

TEST_CASE("SMF vertices with f and t faces, comments and a header") {
    const SourceMesh mesh =
        smf("#$SMF 1.0\n#$vertices 4\n# c\n" + kVertices + "v 1 1 0\nf 1 2 3\nt 2 4 3\nf -4 -3 -1 -2\n");
    REQUIRE(polygons(mesh) == 3);
    CHECK(polygon(mesh, 0) == Indices{0, 1, 2});
    CHECK(polygon(mesh, 1) == Indices{1, 3, 2});
    CHECK(polygon(mesh, 2) == Indices{0, 1, 3, 2});
}

TEST_CASE("SMF attributes bound to vertices") {
    const SourceMesh mesh = smf(kVertices +
                                "f 3 1 2\nbind c vertex\nc 1 0 0\nc 0 1 0\nc 0 0 1\nbind n vertex\nn 0 0 2\nn 0 1 0\n"
                                "n 1 0 0\nbind r vertex\nr 0 0.25\nr 1 0\nr 0 1\n");
    CHECK(mesh.corner_colours == std::vector<std::uint32_t>{0xffff0000u, 0xff0000ffu, 0xff00ff00u});
    REQUIRE(mesh.corner_normals.size() == 3);
    CHECK(mesh.corner_normals[1] == Vec3f(0, 0, 1));
    CHECK(mesh.corner_uvs[1] == Vec2f(0, 0.75f));
}

TEST_CASE("SMF attributes bound to faces") {
    const SourceMesh mesh =
        smf(kVertices + "v 1 1 0\nf 1 2 3\nf 2 4 3\nbind c face\nc 1 0 0\nc 0 1 0\nbind n face\nn 0 0 1\nn 0 1 0\n");
    REQUIRE(mesh.corner_colours.size() == 6);
    CHECK(mesh.corner_colours[2] == 0xff0000ffu);
    CHECK(mesh.corner_colours[3] == 0xff00ff00u);
    CHECK(mesh.corner_normals[4] == Vec3f(0, 1, 0));
}

TEST_CASE("SMF transforms: the last one named acts first, and end restores what begin found") {
    const SourceMesh mesh =
        smf("trans 10 0 0\nbegin\nrot z 90\nscale 2 1 1\nv 1 0 0\nend\nv 1 0 0\nmload 1 0 0 5 0 1 0 0 0 0 1 0 0 0 0 1\n"
            "v 1 0 0\nmmult 2 0 0 0 0 2 0 0 0 0 2 0 0 0 0 1\nv 1 0 0\nf 1 2 3\n");
    check_near(mesh.positions[0], {10, 2, 0});
    check_near(mesh.positions[1], {11, 0, 0});
    check_near(mesh.positions[2], {6, 0, 0});
    check_near(mesh.positions[3], {7, 0, 0});
}

TEST_CASE("SMF normals turn with their vertices and stay perpendicular under uneven scaling") {
    const SourceMesh mesh =
        smf("rot x 90\nscale 1 4 1\n" + kVertices + "f 1 2 3\nbind n vertex\nn 0 0 1\nn 0 1 1\nn 1 0 0\n");
    CHECK((mesh.corner_normals[0] - Vec3f(0, -1, 0)).norm() < 1e-6f);
    CHECK((mesh.corner_normals[1] - Vec3f(0, -1, 0.25f).normalized()).norm() < 1e-6f);
}

TEST_CASE("SMF indices are relative to their block, nested blocks included") {
    const SourceMesh mesh = smf(kVertices + "begin\n" + kVertices + "f 1 2 3\nbegin\n" + kVertices +
                                "f 1 2 3\nend\nf 3 2 1\nend\nf 1 2 3\nset vertex_correction 3\nf 1 2 3\n");
    REQUIRE(polygons(mesh) == 5);
    CHECK(polygon(mesh, 0) == Indices{3, 4, 5});
    CHECK(polygon(mesh, 1) == Indices{6, 7, 8});
    CHECK(polygon(mesh, 2) == Indices{5, 4, 3});
    CHECK(polygon(mesh, 3) == Indices{0, 1, 2});
    CHECK(polygon(mesh, 4) == Indices{3, 4, 5});
}

TEST_CASE("SMF texture beside the mesh") {
    const TemporaryFolder folder;
    std::ofstream(folder / "map.ppm", std::ios::binary) << "P6\n1 1\n255\nabc";
    std::ofstream(folder / "mesh.smf", std::ios::binary)
        << "begin\ntex map.ppm\n" + kVertices + "f 1 2 3\nbind r vertex\nr 0 0\nr 1 0\nr 0 1\nend\n";
    const SourceMesh mesh = read_mesh_file(folder / "mesh.smf");
    REQUIRE(mesh.images.size() == 1);
    CHECK(mesh.materials.at(0).image == 0);
    CHECK(mesh.corner_uvs.size() == 3);
}

TEST_CASE("SMF unknown commands are left out with a warning, malformed ones are errors with their line") {
    const SourceMesh mesh = smf(kVertices + "bogus 1 2 3\nvoodoo\nf 1 2 3\n");
    CHECK(polygons(mesh) == 1);
    REQUIRE(mesh.warnings.size() == 1);
    CHECK_THAT(mesh.warnings[0], Catch::Contains("2 lines") && Catch::Contains("line 4"));
    for (const char* bad :
         {"v 1 2\n", "rot w 90\n", "rot x\n", "end\n", "bind q vertex\n", "c 1 0\n", "mload 1 2 3\n"}) {
        CHECK_THAT(input_error([&] { smf(kVertices + bad); }), Catch::Contains("test.smf: line 4"));
    }
}
