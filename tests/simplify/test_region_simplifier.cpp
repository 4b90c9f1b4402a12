#include "preprocess/model_format/octahedral.h"
#include "tests/simplify/patch_meshes.h"
#include "tests/simplify/simplified.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <array>
#include <vector>

using namespace splice;
using test::Simplified;

namespace {

Vec3f vector_of(const float (&v)[3]) {
    return {v[0], v[1], v[2]};
}

Vec3f normal_of(const format::Vertex& vertex) {
    const auto n = decode_octahedral(vertex.normal);
    return {n[0], n[1], n[2]};
}

}  // namespace

// Scans have steps of no height, whose walls' normals lie in the ground. Here p is below r, and q beside them, where
// the step ends.
TEST_CASE("triangles do not take the normals of slivers at the vertex that they are moved to") {
    constexpr float kStep = 1e-6f, kAside = 4e-6f;
    enum : std::uint32_t { kP, kQ, kR, kWest, kEast, kSouth, kNorth };
    const std::vector<Vec3f> positions{{0, 0, 0},     {kAside, 0, 0}, {0, 0, kStep}, {-1, 0, 0},
                                       {1, 0, -0.1f}, {0, -1, 0},     {0, 1, 0}};
    const std::vector<Triangle> ground{
        {kWest, kSouth, kP}, {kSouth, kEast, kP}, {kNorth, kWest, kR}, {kQ, kNorth, kR}, {kNorth, kQ, kEast}};
    const std::vector<Triangle> walls{{kEast, kQ, kP}, {kQ, kR, kP}, {kR, kWest, kP}};
    std::vector<Triangle> all = ground;
    all.insert(all.end(), walls.begin(), walls.end());
    IndexedMesh mesh = test::mesh_of(positions, all);
    for (std::size_t corner = 0; corner < mesh.corner_normals.size(); ++corner)
        mesh.corner_normals[corner] = corner < 3 * ground.size() ? Vec3f(0, 0, 1) : Vec3f(0, -1, 0);
    Simplified simplified{mesh};
    simplified.shared[kQ] = simplified.shared[kR] = 1;
    const auto levels = simplified.levels(std::array{0.75});
    REQUIRE(levels.size() == 1);
    const RegionLevel& level = levels.front();
    std::size_t wide = 0;
    for (std::size_t i = 0; i < level.triangles.corners.size(); i += 3) {
        std::array<Vec3f, 3> at;
        for (std::size_t k = 0; k < 3; ++k)
            at[k] = vector_of(simplified.vertex(level, level.triangles.corners[i + k]).position);
        const Vec3f cross = (at[1] - at[0]).cross(at[2] - at[0]);
        if (cross.norm() < 0.1f) continue;
        ++wide;
        for (std::size_t k = 0; k < 3; ++k)
            CHECK(normal_of(simplified.vertex(level, level.triangles.corners[i + k])).z() > 0.99f);
    }
    CHECK(wide >= 4);
}
