#include "engine/capture/png_file.h"

#include "preprocess/model_format/atomic_file.h"
#include "preprocess/model_format/error.h"

#include <png.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>
#include <string>

namespace splice {

namespace {

using File = std::unique_ptr<std::FILE, int (*)(std::FILE*)>;

// Frees libpng's part of a picture that was read only by half.
struct PngImage {
    png_image image{};
    PngImage() { image.version = PNG_IMAGE_VERSION; }
    ~PngImage() { png_image_free(&image); }
    PngImage(const PngImage&) = delete;
    PngImage& operator=(const PngImage&) = delete;
};

std::vector<std::uint8_t> without_alpha(const Picture& picture) {
    std::vector<std::uint8_t> rgb;
    rgb.reserve(picture.rgba.size() / 4 * 3);
    for (std::size_t i = 0; i < picture.rgba.size(); i += 4)
        rgb.insert(rgb.end(), picture.rgba.begin() + static_cast<std::ptrdiff_t>(i),
                   picture.rgba.begin() + static_cast<std::ptrdiff_t>(i) + 3);
    return rgb;
}

bool is_opaque(const Picture& picture) {
    for (std::size_t i = 3; i < picture.rgba.size(); i += 4)
        if (picture.rgba[i] != 255) return false;
    return true;
}

std::vector<std::byte> encode_png(const Picture& picture) {
    PngImage png;
    png.image.width = picture.width;
    png.image.height = picture.height;
    const bool opaque = is_opaque(picture);
    png.image.format = opaque ? PNG_FORMAT_RGB : PNG_FORMAT_RGBA;
    const std::vector<std::uint8_t> packed = opaque ? without_alpha(picture) : picture.rgba;
    png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(png.image);
    std::vector<std::byte> bytes(size);
    if (png_image_write_to_memory(&png.image, bytes.data(), &size, 0, packed.data(), 0, nullptr) == 0)
        throw SystemError(std::string("cannot encode a PNG: ") + png.image.message);
    bytes.resize(size);
    return bytes;
}

}  // namespace

void write_png(const std::filesystem::path& path, const Picture& picture) {
    AtomicFile file(path);
    file.write(encode_png(picture));
    file.commit();
}

Picture read_png(const std::filesystem::path& path) {
    const File file(std::fopen(path.c_str(), "rb"), &std::fclose);
    if (!file) throw SystemError("cannot read " + path.string() + ": " + std::strerror(errno));
    PngImage png;
    if (png_image_begin_read_from_stdio(&png.image, file.get()) == 0)
        throw InputError(path.string(), "", std::string("not a PNG: ") + png.image.message);
    png.image.format = PNG_FORMAT_RGBA;
    Picture picture{png.image.width, png.image.height, {}};
    // libpng refuses dimensions above a million; a picture's file holds at least a bit for 1032 bits of pixels.
    constexpr std::uint64_t kMostExpansion = 1040;
    const std::uint64_t bytes = std::uint64_t{4} * picture.width * picture.height;
    if (bytes / 4 / 8 > std::filesystem::file_size(path) * kMostExpansion)
        throw InputError(path.string(), "", "its header promises more pixels than the file can hold");
    picture.rgba.resize(bytes);
    if (png_image_finish_read(&png.image, nullptr, picture.rgba.data(), 0, nullptr) == 0)
        throw InputError(path.string(), "", std::string("damaged PNG: ") + png.image.message);
    return picture;
}

}  // namespace splice
