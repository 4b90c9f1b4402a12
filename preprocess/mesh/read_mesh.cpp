#include "preprocess/mesh/read_mesh.h"

#include "preprocess/mesh/mesh_formats.h"
#include "preprocess/mesh/sniff_format.h"
#include "preprocess/model_format/error.h"

namespace splice {

SourceMesh read_mesh_file(const std::filesystem::path& path) {
    return parse_mesh_file(load_source_file(path));
}

SourceMesh parse_mesh_file(const SourceFile& file) {
    const std::string &bytes = file.bytes, &name = file.name;
    const CompanionFiles companions(file.folder);
    SourceMesh mesh;
    switch (sniff_format(bytes, file.extension, name)) {
        case MeshFormat::kObj:
            mesh = parse_obj(bytes, name, companions);
            break;
        case MeshFormat::kPly:
            mesh = parse_ply(bytes, name, companions);
            break;
        case MeshFormat::kStl:
            mesh = parse_stl(bytes, name);
            break;
        case MeshFormat::kOff:
            mesh = parse_off(bytes, name);
            break;
        case MeshFormat::kSmf:
            mesh = parse_smf(bytes, name, companions);
            break;
    }
    mesh.companions = companions.files_read();
    if (mesh.polygon_begin.size() == 1) {
        throw InputError(name, "",
                         mesh.positions.empty() ? "no faces and no vertices, expected a mesh"
                                                : "no faces, only " + std::to_string(mesh.positions.size()) +
                                                      " points; expected a mesh with faces");
    }
    return mesh;
}

}  // namespace splice
