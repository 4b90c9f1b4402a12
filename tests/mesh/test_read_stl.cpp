#include "tests/mesh/mesh_checks.h"

#include <cstring>

using namespace splice;
using namespace splice::test;

namespace {

SourceMesh stl(const std::string& bytes) {
    return parse_stl(bytes, "test.stl");
}

const std::string kFacet =
    "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\n";

std::string binary(std::uint32_t promised, std::uint32_t present, const std::string& header = "binary") {
    std::string bytes = header;
    bytes.resize(80, ' ');
    bytes.append(reinterpret_cast<const char*>(&promised), 4);
    for (std::uint32_t t = 0; t < present; ++t) {
        const float shift = static_cast<float>(t);
        const float values[12] = {0, 0, 1, shift, 0, 0, shift + 1, 0, 0, shift, 1, 0};
        bytes.append(reinterpret_cast<const char*>(values), sizeof values);
        bytes.append(2, '\0');
    }
    return bytes;
}

}  // namespace

TEST_CASE("STL ascii, several solids, one of them empty") {
    const SourceMesh mesh = stl("solid a b c\n" + kFacet + "endsolid a b c\nsolid\nendsolid\nsolid vertex\n" + kFacet +
                                kFacet + "endsolid vertex\n");
    REQUIRE(polygons(mesh) == 3);
    CHECK(mesh.positions.size() == 9);
    CHECK(mesh.positions[1] == Vec3d(1, 0, 0));
    CHECK(mesh.corner_normals.empty());  // repair computes better ones
}

TEST_CASE("STL binary, also where the header starts with \"solid\"") {
    for (const char* header : {"binary", "solid made by a careless program"}) {
        const SourceMesh mesh = stl(binary(2, 2, header));
        REQUIRE(polygons(mesh) == 2);
        CHECK(mesh.positions[4] == Vec3d(2, 0, 0));
    }
}

TEST_CASE("STL binary with bytes after the last triangle is read with a warning") {
    const SourceMesh mesh = stl(binary(1, 2));
    CHECK(polygons(mesh) == 1);
    CHECK(mesh.warnings.size() == 1);
}

TEST_CASE("STL binary that promises more than it holds is refused") {
    CHECK_THAT(input_error([] { stl(binary(4000000000u, 2)); }),
               Catch::Contains("byte 80") && Catch::Contains("4000000000") && Catch::Contains("2"));
    CHECK_THAT(input_error([] { stl("short"); }), Catch::Contains("84-byte"));
}

TEST_CASE("STL ascii errors name the line") {
    CHECK_THAT(input_error([] { stl("solid\nfacet normal 0 0 1\nouter loop\nvertex 0 0\nendloop\n"); }),
               Catch::Contains("line 5"));
    CHECK_THAT(input_error([] { stl("solid\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 0 1 0"); }),
               Catch::Contains("inside a facet"));
}

TEST_CASE("STL facets of more than three corners are polygons") {
    const SourceMesh mesh =
        stl("solid\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 1 1 0\nvertex 0 1 0\n"
            "endloop\nendfacet\nendsolid\n");
    REQUIRE(polygons(mesh) == 1);
    CHECK(polygon(mesh, 0).size() == 4);
}
