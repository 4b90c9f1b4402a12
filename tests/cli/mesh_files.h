// Mesh files for the programs to read.
#pragma once

#include <filesystem>

namespace splice::test {

/// A cube of twelve triangles, OBJ.
void write_cube(const std::filesystem::path& path);

/// A closed surface with flat and rough regions, OFF; `rings` x 2 rings triangles x 2.
void write_bumpy_torus(const std::filesystem::path& path, unsigned rings);

}  // namespace splice::test
