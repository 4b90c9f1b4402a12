#include "preprocess/mesh/source_mesh_builder.h"

namespace splice {
namespace {

template <class Value>
void expand(const std::vector<Value>& per_vertex, const Value& missing,
            const std::vector<std::uint32_t>& corner_position, std::vector<Value>& corners) {
    if (per_vertex.empty() || !corners.empty()) return;
    corners.resize(corner_position.size(), missing);
    for (std::size_t i = 0; i < corner_position.size(); ++i) {
        if (corner_position[i] < per_vertex.size()) corners[i] = per_vertex[corner_position[i]];
    }
}

}  // namespace

void warn(SourceMesh& mesh, const std::string& warning) {
    constexpr std::size_t kMost = 20;
    if (mesh.warnings.size() < kMost) {
        mesh.warnings.push_back(warning);
    } else if (mesh.warnings.size() == kMost) {
        mesh.warnings.emplace_back("more warnings are left out");
    }
}

void expand_vertex_attributes(const VertexAttributes& attributes, SourceMesh& mesh) {
    expand<Vec3f>(attributes.normals, Vec3f::Zero(), mesh.corner_position, mesh.corner_normals);
    expand<Vec2f>(attributes.uvs, Vec2f::Zero(), mesh.corner_position, mesh.corner_uvs);
    expand<std::uint32_t>(attributes.colours, kWhite, mesh.corner_position, mesh.corner_colours);
}

void add_image_material(const std::string& image_name, const CompanionFiles& companions, SourceMesh& mesh) {
    MeshMaterial material;
    material.name = image_name;
    std::string problem;
    if (auto image = companions.read_image(image_name, problem)) {
        material.image = static_cast<std::uint32_t>(mesh.images.size());
        mesh.images.push_back(std::move(*image));
    } else {
        warn(mesh, problem);
    }
    mesh.materials.push_back(std::move(material));
}

}  // namespace splice
