// Whole files in memory, and gzip.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace splice {

/// Throws InputError if `path` is no regular file, SystemError if the system refuses.
std::string read_file_bytes(const std::filesystem::path& path);

bool is_gzip(std::string_view bytes);

/// Throws InputError naming `name` if the stream is damaged or cut, or expands beyond what a mesh believably does (100
/// times its size, or 64 MiB if that is more: the most that deflate could do is 1032 times).
std::string gunzip(std::string_view bytes, const std::string& name);

}  // namespace splice
