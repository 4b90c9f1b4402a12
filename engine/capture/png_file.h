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

/// Alpha is stored only where it is not 255 throughout. `path` becomes the whole picture or stays as it is. Throws
/// SystemError.
void write_png(const std::filesystem::path& path, const Picture& picture);

/// Throws InputError, SystemError.
Picture read_png(const std::filesystem::path& path);

}  // namespace splice
