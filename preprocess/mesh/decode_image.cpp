#include "preprocess/mesh/companion_files.h"

// Only the formats that meshes come with; the rarer decoders of stb_image are its attack surface.
#define STBI_ONLY_PNG
#define STBI_ONLY_JPEG
#define STBI_ONLY_BMP
#define STBI_ONLY_TGA
#define STBI_ONLY_PNM
#define STBI_NO_STDIO
#define STB_IMAGE_STATIC
#ifndef __clang_analyzer__  // what it finds in there is not ours to mend
#define STB_IMAGE_IMPLEMENTATION
#endif
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#include <stb/stb_image.h>
#pragma GCC diagnostic pop

#include <limits>
#include <memory>

namespace splice {
namespace {

/// PNM and plain TGA hold their texels as they are, and stb_image would leave those beyond the end of the file
/// uninitialised.
bool lacks_raw_texels(std::string_view bytes, int width, int height, int channels) {
    constexpr std::size_t kTgaHeader = 18;
    const std::uint64_t texels = static_cast<std::uint64_t>(width) * static_cast<std::uint64_t>(height);
    if (bytes[0] == 'P' && (bytes[1] == '5' || bytes[1] == '6')) {
        return bytes.size() < texels * static_cast<std::uint64_t>(channels);
    }
    const bool other_magic = bytes[0] == 'B' || bytes[0] == '\x89' || bytes[0] == '\xff';
    if (other_magic || bytes.size() < kTgaHeader) return false;
    const bool run_length_coded = (bytes[2] & 8) != 0;
    return !run_length_coded && bytes.size() < kTgaHeader + texels * (static_cast<unsigned char>(bytes[16]) / 8u);
}

}  // namespace

std::optional<Image> decode_image(std::string_view bytes, std::string& problem) {
    if (bytes.size() > static_cast<std::size_t>(std::numeric_limits<int>::max())) {
        problem = "larger than 2 GiB";
        return std::nullopt;
    }
    const auto* data = reinterpret_cast<const stbi_uc*>(bytes.data());
    const int size = static_cast<int>(bytes.size());
    int width = 0, height = 0, channels = 0;
    if (stbi_info_from_memory(data, size, &width, &height, &channels) == 0 || width <= 0 || height <= 0) {
        problem = "not a PNG, JPEG, BMP, TGA or PPM image";
        return std::nullopt;
    }
    // A deflate stream cannot expand more than 1032 times: a header that promises more than that lies.
    const std::uint64_t texel_bytes = 4ull * static_cast<std::uint64_t>(width) * static_cast<std::uint64_t>(height);
    if (texel_bytes > 1032ull * 32 * (bytes.size() + 1024)) {
        problem = std::to_string(width) + " x " + std::to_string(height) + " pixels cannot come from " +
                  std::to_string(bytes.size()) + " bytes";
        return std::nullopt;
    }
    if (lacks_raw_texels(bytes, width, height, channels)) {
        problem = "cut short";
        return std::nullopt;
    }
    const std::unique_ptr<stbi_uc, decltype(&stbi_image_free)> pixels(
        stbi_load_from_memory(data, size, &width, &height, &channels, 4), &stbi_image_free);
    if (!pixels) {
        problem = std::string("damaged (") + stbi_failure_reason() + ")";
        return std::nullopt;
    }
    Image image;
    image.width = static_cast<std::uint32_t>(width);
    image.height = static_cast<std::uint32_t>(height);
    image.rgba.assign(pixels.get(), pixels.get() + texel_bytes);
    return image;
}

}  // namespace splice
