// Which format a file is in: by what it holds first, by its name's ending only where the content does not tell.
#pragma once

#include <string>
#include <string_view>

namespace splice {

enum class MeshFormat { kObj, kPly, kStl, kOff, kSmf };

/// `extension` with its dot, any case. Throws InputError if the bytes are in no format that can be read.
MeshFormat sniff_format(std::string_view bytes, std::string extension, const std::string& name);

/// True if the size agrees with the triangle count of a binary STL header.
bool is_binary_stl(std::string_view bytes);

}  // namespace splice
