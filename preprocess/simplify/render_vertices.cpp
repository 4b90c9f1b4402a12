#include "preprocess/model_format/octahedral.h"
#include "preprocess/model_format/srgb.h"
#include "preprocess/simplify/simplify_patches.h"

namespace splice {
namespace {

constexpr std::uint32_t kNone = 0xffffffffu;

format::Vertex corner_vertex(const IndexedMesh& mesh, std::size_t triangle, std::size_t k) {
    const std::size_t corner = 3 * triangle + k;
    format::Vertex vertex{};
    const Vec3f& position = mesh.positions[mesh.triangles[triangle][k]];
    const Vec3f& normal = mesh.corner_normals[corner];
    for (int axis = 0; axis < 3; ++axis)
        vertex.position[axis] = position[axis];
    vertex.normal = encode_octahedral(normal.x(), normal.y(), normal.z());
    const std::size_t material = mesh.triangle_material.empty() ? 0 : mesh.triangle_material[triangle];
    const std::uint32_t colour = mesh.corner_colours.empty() ? kWhite : mesh.corner_colours[corner];
    vertex.colour = multiply_colours(mesh.materials[material].diffuse, colour);
    if (!mesh.corner_uvs.empty()) {
        vertex.uv[0] = mesh.corner_uvs[corner].x();
        vertex.uv[1] = mesh.corner_uvs[corner].y();
    }
    return vertex;
}

bool same_attributes(const format::Vertex& a, const format::Vertex& b) {
    return a.normal == b.normal && a.colour == b.colour && a.uv[0] == b.uv[0] && a.uv[1] == b.uv[1];
}

}  // namespace

RenderVertices build_render_vertices(const IndexedMesh& mesh) {
    RenderVertices result;
    result.indices.reserve(3 * mesh.triangles.size());
    result.vertices.reserve(mesh.positions.size());
    result.position.reserve(mesh.positions.size());
    // The vertices made so far for each position, as a list: most positions have one, a crease two, a corner a few.
    std::vector<std::uint32_t> first_at_position(mesh.positions.size(), kNone);
    std::vector<std::uint32_t> next_at_position;
    next_at_position.reserve(mesh.positions.size());
    for (std::size_t triangle = 0; triangle < mesh.triangles.size(); ++triangle) {
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t position = mesh.triangles[triangle][k];
            const format::Vertex vertex = corner_vertex(mesh, triangle, k);
            std::uint32_t id = first_at_position[position];
            while (id != kNone && !same_attributes(result.vertices[id], vertex))
                id = next_at_position[id];
            if (id == kNone) {
                id = static_cast<std::uint32_t>(result.vertices.size());
                result.vertices.push_back(vertex);
                result.position.push_back(position);
                next_at_position.push_back(first_at_position[position]);
                first_at_position[position] = id;
            }
            result.indices.push_back(id);
        }
    }
    return result;
}

}  // namespace splice
