// Names of files that keys and buttons write: nothing that is there is written over.
#pragma once

#include <filesystem>

namespace splice {

/// `path`, or the first of NAME-1.png, NAME-2.png ... that is not there.
std::filesystem::path free_name(const std::filesystem::path& path);

/// The same for `count` pictures that are numbered on from the name (NAME-000.png ...): none of them is there.
std::filesystem::path free_series(const std::filesystem::path& path, std::size_t count);

}  // namespace splice
