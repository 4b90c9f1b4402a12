// Material libraries (.mtl) of an OBJ file, with their textures.
#pragma once

#include "preprocess/mesh/companion_files.h"
#include "preprocess/mesh/read_mesh.h"

#include <map>
#include <string>
#include <string_view>

namespace splice {

class ObjMaterials {
  public:
    explicit ObjMaterials(const CompanionFiles& companions) : companions_(companions) {}

    /// `names` is the rest of an mtllib line: one name, possibly with blanks, or several. Problems become warnings.
    void load_libraries(const std::string& names, SourceMesh& mesh);

    /// Appends the materials in the text of a library; the first of equal names counts.
    void parse_library(std::string_view text, SourceMesh& mesh);

    /// Index into mesh.materials. The empty name is a white default; unknown names share it, with a warning.
    std::uint32_t use(const std::string& name, SourceMesh& mesh);

  private:
    const CompanionFiles& companions_;
    std::map<std::string, std::uint32_t> by_name_;
    std::map<std::string, std::uint32_t> image_by_name_;
};

}  // namespace splice
