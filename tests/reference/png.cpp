#include "tests/reference/png.h"

#include <stb/stb_image_write.h>

#include <algorithm>
#include <cstdlib>
#include <stdexcept>

namespace splice::reference {

void write_png(const std::filesystem::path& path, const ColourImage& image) {
    static_assert(sizeof(Rgb8) == 3);
    if (!stbi_write_png(path.c_str(), static_cast<int>(image.width), static_cast<int>(image.height), 3,
                        image.pixels.data(), static_cast<int>(image.width) * 3))
        throw std::runtime_error("cannot write " + path.string());
}

ColourImage difference(const ColourImage& image, const ColourImage& reference, int gain) {
    ColourImage result(image.width, image.height);
    const auto channel = [&](int a, int b) { return static_cast<std::uint8_t>(std::min(255, gain * std::abs(a - b))); };
    std::transform(image.pixels.begin(), image.pixels.end(), reference.pixels.begin(), result.pixels.begin(),
                   [&](Rgb8 a, Rgb8 b) {
                       return Rgb8{channel(a.r, b.r), channel(a.g, b.g), channel(a.b, b.b)};
                   });
    return result;
}

}  // namespace splice::reference
