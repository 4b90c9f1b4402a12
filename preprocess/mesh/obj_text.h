// Makes hostile or merely untidy OBJ text safe for tinyobjloader, which reads `nan` as 0, wraps long indices around,
// has no vertex colours in its callback interface and splits file names at blanks.
#pragma once

#include "preprocess/mesh/indexed_mesh.h"

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace splice {

struct ObjText {
    /// Only v, vt, vn, f, usemtl and mtllib statements, one a line, ended by \n, continuation lines joined, names of
    /// material libraries with escaped blanks. Coordinates that are no numbers are infinite, indices too long for an
    /// int 0.
    std::string statements;
    std::vector<std::array<float, 3>> vertex_colours;  // empty or one a `v`, as written; NaN where a vertex has none
    std::vector<std::uint32_t> face_lines;             // line of each `f` in `statements`
};

ObjText tidy_obj_text(std::string_view bytes);

}  // namespace splice
