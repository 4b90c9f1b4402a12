// A file on its way to a parser: its bytes, no longer gzipped, and what its name says.
#pragma once

#include <filesystem>
#include <string>

namespace splice {

struct SourceFile {
    std::string name;              // for messages
    std::string bytes;             // uncompressed
    std::string extension;         // with its dot, in lower case, that of the file inside where gzipped
    std::filesystem::path folder;  // for files that it names
};

/// Throws InputError, SystemError.
SourceFile load_source_file(const std::filesystem::path& path);

}  // namespace splice
