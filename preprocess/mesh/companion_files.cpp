#include "preprocess/mesh/companion_files.h"

#include "preprocess/mesh/file_bytes.h"
#include "preprocess/mesh/text_scanner.h"
#include "preprocess/model_format/error.h"

#include <algorithm>

namespace splice {
namespace fs = std::filesystem;

std::optional<fs::path> CompanionFiles::find(const std::string& name, std::string& problem) const {
    std::string portable = name;
    std::replace(portable.begin(), portable.end(), '\\', '/');
    const fs::path relative(portable);
    const bool leaves =
        relative.is_absolute() || portable.find(':') != std::string::npos || portable.find('\0') != std::string::npos ||
        std::any_of(relative.begin(), relative.end(), [](const fs::path& part) { return part == ".."; });
    if (leaves) {
        problem = "refused, because it leaves the folder of the mesh";
        return std::nullopt;
    }
    problem = "not found";
    if (!folder_ || portable.empty()) return std::nullopt;
    std::error_code error;
    const fs::path base = fs::canonical(folder_->empty() ? fs::path(".") : *folder_, error);
    if (error) return std::nullopt;
    const fs::path file = fs::canonical(base / relative, error);
    if (error || !fs::is_regular_file(file, error)) return std::nullopt;
    // A symbolic link may leave the folder as well.
    if (std::mismatch(base.begin(), base.end(), file.begin(), file.end()).first != base.end()) {
        problem = "refused, because it leaves the folder of the mesh";
        return std::nullopt;
    }
    return file;
}

bool CompanionFiles::contains(const std::string& name) const {
    std::string problem;
    return find(name, problem).has_value();
}

std::optional<std::string> CompanionFiles::read(const std::string& name, std::string& problem) const {
    const auto file = find(name, problem);
    try {
        if (file) {
            files_read_.push_back(*file);
            return read_file_bytes(*file);
        }
    } catch (const Error& e) {
        problem = e.what();
    }
    problem = "file \"" + printable(name) + "\" " + problem;
    return std::nullopt;
}

std::optional<Image> CompanionFiles::read_image(const std::string& name, std::string& problem) const {
    const auto bytes = read(name, problem);
    if (!bytes) return std::nullopt;
    auto image = decode_image(*bytes, problem);
    if (!image) problem = "image \"" + printable(name) + "\" is " + problem;
    return image;
}

}  // namespace splice
