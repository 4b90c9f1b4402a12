#include "preprocess/mesh/shapes.h"
#include "preprocess/mesh/write_mesh.h"
#include "tests/mesh/mesh_checks.h"
#include "tests/support/test_files.h"

using namespace splice;
using namespace splice::test;

TEST_CASE("A written OBJ reads back the same: positions, polygons, uvs, material, image") {
    const TemporaryFolder folder;
    const SourceMesh mesh = shapes::checkerboard(2, 3);
    write_obj(mesh, folder / "checker board.obj");
    const SourceMesh back = read_mesh_file(folder / "checker board.obj");
    CHECK(back.positions == mesh.positions);
    CHECK(back.polygon_begin == mesh.polygon_begin);
    CHECK(back.corner_position == mesh.corner_position);
    REQUIRE(back.corner_uvs.size() == mesh.corner_uvs.size());
    for (std::size_t i = 0; i < mesh.corner_uvs.size(); ++i)
        CHECK((back.corner_uvs[i] - mesh.corner_uvs[i]).norm() < 1e-6f);
    REQUIRE(back.images.size() == 1);
    CHECK(back.images[0].rgba == mesh.images[0].rgba);
    CHECK(back.materials.at(back.polygon_material.at(0)).image == 0);
    CHECK(back.warnings.empty());
}

TEST_CASE("A written OBJ keeps vertex colours and normals") {
    const TemporaryFolder folder;
    const SourceMesh mesh = shapes::bumpy_sphere(100);
    write_obj(mesh, folder / "sphere.obj");
    const SourceMesh back = read_mesh_file(folder / "sphere.obj");
    CHECK(back.corner_colours == mesh.corner_colours);
    REQUIRE(back.corner_normals.size() == mesh.corner_normals.size());
    for (std::size_t i = 0; i < mesh.corner_normals.size(); ++i) {
        CHECK((back.corner_normals[i] - mesh.corner_normals[i]).norm() < 1e-6f);
    }
}

TEST_CASE("A written PLY reads back the same to single precision") {
    const TemporaryFolder folder;
    const SourceMesh mesh = shapes::torus_knot(2, 3, 40, 8);
    write_ply(mesh, folder / "knot.ply");
    const SourceMesh back = read_mesh_file(folder / "knot.ply");
    REQUIRE(back.corner_position.size() == mesh.corner_position.size());
    CHECK(back.positions.size() == mesh.positions.size());
    CHECK(back.corner_colours == mesh.corner_colours);
    for (std::size_t i = 0; i < mesh.corner_position.size(); ++i) {
        CHECK((back.positions[back.corner_position[i]] - mesh.positions[mesh.corner_position[i]]).norm() < 1e-6);
    }
}

TEST_CASE("Writing where nothing can be written is a SystemError") {
    CHECK_THROWS_AS(write_obj(shapes::cube(), "/nonexistent/folder/cube.obj"), SystemError);
    CHECK_THROWS_AS(write_ply(shapes::cube(), "/nonexistent/folder/cube.ply"), SystemError);
}
