// The mesh that every stage after repair works on. Topology is by welded position; everything that may differ around a
// vertex (normal at a crease, uv at a seam, colour) is stored per corner. Flat arrays, no pointers.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace splice {

using Vec3f = Eigen::Vector3f;
using Vec3d = Eigen::Vector3d;
using Vec2f = Eigen::Vector2f;
using Triangle = std::array<std::uint32_t, 3>;

/// 8-bit sRGB-encoded RGBA, rows top to bottom.
struct Image {
    std::uint32_t width = 0, height = 0;
    std::vector<std::uint8_t> rgba;
};

inline constexpr std::uint32_t kNoImage = 0xffffffffu;
inline constexpr std::uint32_t kWhite = 0xffffffffu;

struct MeshMaterial {
    std::string name;
    std::uint32_t diffuse = kWhite;  // sRGB RGBA8, R in the lowest byte
    std::uint32_t image = kNoImage;  // index into IndexedMesh::images
};

/// Invariants after repair_mesh: indices in range, the three of a triangle distinct, no triangle of zero area, no
/// duplicate triangles, all positions finite and inside the unit box centred at the origin, every position used,
/// corner arrays either empty or of size 3 * triangles.size() (corner 3 * t + k belongs to triangles[t][k]).
struct IndexedMesh {
    std::vector<Vec3f> positions;                  // unit-box units
    std::vector<Triangle> triangles;               // counter-clockwise from outside
    std::vector<Vec3f> corner_normals;             // unit; never empty after repair
    std::vector<Vec2f> corner_uvs;                 // empty: none; v grows downwards
    std::vector<std::uint32_t> corner_colours;     // empty: white; sRGB RGBA8, R in the lowest byte
    std::vector<std::uint32_t> triangle_material;  // empty: material 0 everywhere
    std::vector<MeshMaterial> materials;           // at least one after repair
    std::vector<Image> images;

    // source = unit * source_scale + source_offset
    double source_scale = 1.0;
    Vec3d source_offset = Vec3d::Zero();

    bool closed = false;                 // no boundary and no non-manifold edge
    bool consistently_oriented = false;  // every inner edge is used once in each direction
    bool has_colours = false;            // the input had vertex or face colours
};

}  // namespace splice
