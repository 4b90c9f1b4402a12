// The parsers behind read_mesh_file: bytes in memory -> SourceMesh. None of them opens a file except through
// CompanionFiles, none trusts a count, and each reads what is merely awkward (repair_mesh judges it). What cannot be
// read throws InputError with `name` and a line or byte offset.
#pragma once

#include "preprocess/mesh/companion_files.h"
#include "preprocess/mesh/read_mesh.h"

#include <string>
#include <string_view>

namespace splice {

/// Wavefront OBJ: polygons, negative indices, vertex colours (`v x y z r g b`, 0..1 or 0..255), materials (Kd, map_Kd).
SourceMesh parse_obj(std::string_view bytes, const std::string& name, const CompanionFiles& companions);

/// PLY 1.0 (Turk 1994): ascii and both binary orders; faces with per-vertex or per-face attributes, triangle strips.
SourceMesh parse_ply(std::string_view bytes, const std::string& name, const CompanionFiles& companions);

/// STL, ascii (any number of solids) or binary (told by the file's size, as many binary files start with "solid" too).
SourceMesh parse_stl(std::string_view bytes, const std::string& name);

/// Geomview OFF with its prefixes ST, C, N, 4 (ascii).
SourceMesh parse_off(std::string_view bytes, const std::string& name);

/// Garland's SMF: v, f, t, bind and c/n/r, begin/end, trans, scale, rot, mmult, mload, set vertex_correction, tex.
SourceMesh parse_smf(std::string_view bytes, const std::string& name, const CompanionFiles& companions);

}  // namespace splice
