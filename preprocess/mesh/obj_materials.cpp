#include "preprocess/mesh/obj_materials.h"

#include "preprocess/mesh/source_mesh_builder.h"
#include "preprocess/mesh/text_scanner.h"

#include <tiny_obj_loader.h>

#include <sstream>

namespace splice {
namespace {

/// tinyobjloader makes materials without Kd black, or grey if they have a texture; a mesh without colour is white.
std::string with_default_colours(std::string_view library) {
    std::string text;
    TextScanner lines(library);
    while (!lines.at_end()) {
        const std::string_view line = lines.line();
        if (line.find('\0') != std::string_view::npos) continue;
        text.append(line);
        text += '\n';
        if (TextScanner(line).token() == "newmtl") text += "Kd 1 1 1\n";
    }
    return text;
}

}  // namespace

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
        std::string problem;
        if (const auto text = companions_.read(library, problem)) {
            parse_library(*text, mesh);
        } else {
            warn(mesh, problem);
        }
    }
}

void ObjMaterials::parse_library(std::string_view text, SourceMesh& mesh) {
    std::istringstream stream(with_default_colours(text));
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
                std::string problem;
                if (auto image = companions_.read_image(texture, problem)) {
                    entry->second = static_cast<std::uint32_t>(mesh.images.size());
                    mesh.images.push_back(std::move(*image));
                } else {
                    warn(mesh, problem);
                }
            }
            material.image = entry->second;
        }
        by_name_.emplace(name, static_cast<std::uint32_t>(mesh.materials.size()));
        mesh.materials.push_back(std::move(material));
    }
}

std::uint32_t ObjMaterials::use(const std::string& name, SourceMesh& mesh) {
    const auto known = by_name_.find(name);
    if (known != by_name_.end()) return known->second;
    if (!name.empty()) {
        warn(mesh, "material \"" + printable(name) + "\" not found, using white");
        return by_name_[name] = use("", mesh);
    }
    mesh.materials.emplace_back();
    return by_name_[name] = static_cast<std::uint32_t>(mesh.materials.size() - 1);
}

}  // namespace splice
