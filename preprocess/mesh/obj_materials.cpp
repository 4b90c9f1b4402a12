#include "preprocess/mesh/obj_materials.h"

#include "preprocess/mesh/source_mesh_builder.h"
#include "preprocess/mesh/text_scanner.h"

#include <tiny_obj_loader.h>

#include <sstream>

namespace splice {

void ObjMaterials::load_libraries(const std::string& names, SourceMesh& mesh) {
    std::vector<std::string> libraries;
    if (companions_.contains(names)) {
        libraries.push_back(names);
    } else {
        TextScanner words(names);
        for (std::string_view word = words.token(); !word.empty(); word = words.token())
            libraries.emplace_back(word);
    }
    for (const std::string& library : libraries) {
        if (const auto text = companions_.read(library, mesh.warnings)) parse_library(*text, mesh);
    }
}

void ObjMaterials::parse_library(std::string_view text, SourceMesh& mesh) {
    std::string clean(text);
    std::erase(clean, '\0');
    std::istringstream stream(clean);
    std::map<std::string, int> ids;
    std::vector<tinyobj::material_t> materials;
    std::string warning, error;
    tinyobj::LoadMtl(&ids, &materials, &stream, &warning, &error);
    for (const tinyobj::material_t& source : materials) {
        const std::string name(trimmed(source.name));
        if (by_name_.contains(name)) continue;
        MeshMaterial material;
        material.name = name;
        material.diffuse = pack_colour(source.diffuse[0], source.diffuse[1], source.diffuse[2]);
        const std::string texture(trimmed(source.diffuse_texname));
        if (!texture.empty()) {
            const auto [entry, is_new] = image_by_name_.try_emplace(texture, kNoImage);
            if (is_new) {
                if (auto image = companions_.read_image(texture, mesh.warnings)) {
                    entry->second = static_cast<std::uint32_t>(mesh.images.size());
                    mesh.images.push_back(std::move(*image));
                }
            }
            material.image = entry->second;
        }
        by_name_.emplace(name, static_cast<std::uint32_t>(mesh.materials.size()));
        mesh.materials.push_back(std::move(material));
    }
}

std::uint32_t ObjMaterials::use(const std::string& name, SourceMesh& mesh) {
    const auto [entry, is_new] = by_name_.try_emplace(name, static_cast<std::uint32_t>(mesh.materials.size()));
    if (is_new) {
        if (!name.empty()) mesh.warnings.push_back("material \"" + name + "\" not found, using white");
        MeshMaterial material;
        material.name = name;
        mesh.materials.push_back(std::move(material));
    }
    return entry->second;
}

}  // namespace splice
