#include "preprocess/model_format/octahedral.h"
#include "preprocess/simplify/simplify_patches.h"
#include "tests/simplify/patch_meshes.h"

#include <catch2/catch.hpp>

using namespace splice;

namespace {

IndexedMesh two_triangles() {
    return test::mesh_of({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, {{0, 1, 2}, {0, 2, 3}});
}

}  // namespace

TEST_CASE("corners with equal attributes share a vertex") {
    const IndexedMesh mesh = two_triangles();
    const RenderVertices render = build_render_vertices(mesh);
    CHECK(render.vertices.size() == 4);
    REQUIRE(render.indices.size() == 6);
    CHECK(render.indices[0] == render.indices[3]);
    CHECK(render.indices[2] == render.indices[4]);
    for (std::size_t corner = 0; corner < 6; ++corner)
        CHECK(render.position[render.indices[corner]] == mesh.triangles[corner / 3][corner % 3]);
}

TEST_CASE("a vertex is split where a normal, uv, colour or material colour differs") {
    IndexedMesh mesh = two_triangles();
    SECTION("normal") {
        mesh.corner_normals[3] = Vec3f::UnitX();
    }
    SECTION("uv") {
        mesh.corner_uvs.assign(6, Vec2f(0, 0));
        mesh.corner_uvs[3] = Vec2f(0, 1);
    }
    SECTION("colour") {
        mesh.corner_colours.assign(6, kWhite);
        mesh.corner_colours[3] = 0xff0000ffu;
    }
    CHECK(build_render_vertices(mesh).vertices.size() == 5);
}

TEST_CASE("a vertex's colour is its own times its material's") {
    IndexedMesh mesh = two_triangles();
    mesh.corner_colours.assign(6, 0xff00ffffu);  // yellow
    mesh.materials = {{"white", kWhite, kNoImage}, {"cyan", 0xffffff00u, kNoImage}};
    mesh.triangle_material = {0, 1};
    const RenderVertices render = build_render_vertices(mesh);
    CHECK(render.vertices.size() == 6);  // both shared positions are split
    CHECK(render.vertices[render.indices[0]].colour == 0xff00ffffu);
    CHECK(render.vertices[render.indices[3]].colour == 0xff00ff00u);
}

TEST_CASE("a vertex carries what its corner says") {
    IndexedMesh mesh = two_triangles();
    mesh.corner_uvs.assign(6, Vec2f(0.25f, 0.75f));
    const RenderVertices render = build_render_vertices(mesh);
    const format::Vertex& vertex = render.vertices[render.indices[1]];
    CHECK(vertex.position[0] == 1.0f);
    CHECK(vertex.uv[0] == 0.25f);
    CHECK(vertex.uv[1] == 0.75f);
    CHECK(decode_octahedral(vertex.normal)[2] == 1.0f);
}
