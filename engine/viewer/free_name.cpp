#include "engine/viewer/free_name.h"

#include "engine/capture/camera_path.h"

#include <functional>
#include <string>

namespace splice {

namespace {

std::filesystem::path first_free(const std::filesystem::path& path,
                                 const std::function<bool(const std::filesystem::path&)>& taken) {
    std::filesystem::path candidate = path;
    for (std::size_t i = 1; taken(candidate); ++i)
        candidate = path.parent_path() / (path.stem().string() + "-" + std::to_string(i) + path.extension().string());
    return candidate;
}

// A link to nowhere is something, too.
bool is_there(const std::filesystem::path& path) {
    std::error_code status;
    return std::filesystem::exists(std::filesystem::symlink_status(path, status));
}

}  // namespace

std::filesystem::path free_name(const std::filesystem::path& path) {
    return first_free(path, is_there);
}

std::filesystem::path free_series(const std::filesystem::path& path, std::size_t count) {
    return first_free(path, [&](const std::filesystem::path& candidate) {
        for (std::size_t i = 0; i < count; ++i)
            if (is_there(numbered(candidate, i, count))) return true;
        return false;
    });
}

}  // namespace splice
