// 8-bit RGBA pictures as PNG files.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

namespace splice {

struct Picture {
    std::uint32_t width = 0, height = 0;
    std::vector<std::uint8_t> rgba;  // sRGB-encoded, rows top to bottom, alpha not premultiplied
};

/// Alpha is stored only where it is not 255 throughout. Written beside and renamed, so that `path` is either the whole
/// picture or untouched. Throws SystemError.
void write_png(const std::filesystem::path& path, const Picture& picture);

/// Throws InputError, SystemError.
Picture read_png(const std::filesystem::path& path);

}  // namespace splice
