#include "preprocess/mesh/source_file.h"

#include "preprocess/mesh/file_bytes.h"

#include <algorithm>
#include <cctype>

namespace splice {

SourceFile load_source_file(const std::filesystem::path& path) {
    SourceFile file;
    file.name = path.string();
    file.bytes = read_file_bytes(path);
    if (is_gzip(file.bytes)) file.bytes = gunzip(file.bytes, file.name);
    std::filesystem::path bare = path.filename();
    if (bare.extension() == ".gz") bare.replace_extension();
    file.extension = bare.extension().string();
    std::transform(file.extension.begin(), file.extension.end(), file.extension.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    file.folder = path.parent_path();
    return file;
}

}  // namespace splice
