// GLSL to SPIR-V within the program (libglslang), with the settings of cmake/shaders.cmake.
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

namespace splice {

/// The stage by the extension: .vert, .frag, .comp. Files that it includes are looked for in `include_folder`. Throws
/// InputError("FILE: line: message") with all of the compiler's complaints, SystemError.
std::vector<std::uint32_t> compile_shader(const std::filesystem::path& source,
                                          const std::filesystem::path& include_folder);

}  // namespace splice
