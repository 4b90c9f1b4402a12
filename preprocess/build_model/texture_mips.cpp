#include "preprocess/build_model/texture_mips.h"

#include "preprocess/model_format/srgb.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <span>

namespace splice {
namespace {

struct Overlap {
    std::uint32_t source;
    float length;
};

// The source texels under the box of texel `i` of `target_size`, and how much of each; at most four.
struct Box1d {
    std::array<Overlap, 4> overlaps{};
    std::size_t count = 0;

    Box1d(std::uint32_t i, std::uint32_t source_size, std::uint32_t target_size) {
        const double scale = static_cast<double>(source_size) / target_size;
        const double begin = i * scale, end = (i + 1) * scale;
        for (auto source = static_cast<std::uint32_t>(begin); source < source_size && source < end; ++source) {
            const double length = std::min(end, source + 1.0) - std::max(begin, static_cast<double>(source));
            if (length > 1e-9 && count < overlaps.size()) overlaps[count++] = {source, static_cast<float>(length)};
        }
    }
};

std::array<float, 4> texel(const Image& image, std::uint32_t x, std::uint32_t y) {
    const std::uint8_t* bytes = &image.rgba[(std::size_t{y} * image.width + x) * 4];
    return {linear_from_srgb(bytes[0]), linear_from_srgb(bytes[1]), linear_from_srgb(bytes[2]),
            static_cast<float>(bytes[3]) / 255};
}

std::array<float, 4> average(const Image& image, const Box1d& columns, const Box1d& rows) {
    std::array<float, 3> opaque{}, plain{};  // weighted by alpha, and without
    float alpha = 0, area = 0;
    for (std::size_t r = 0; r < rows.count; ++r) {
        for (std::size_t c = 0; c < columns.count; ++c) {
            const float weight = rows.overlaps[r].length * columns.overlaps[c].length;
            const auto colour = texel(image, columns.overlaps[c].source, rows.overlaps[r].source);
            for (std::size_t i = 0; i < 3; ++i) {
                opaque[i] += weight * colour[3] * colour[i];
                plain[i] += weight * colour[i];
            }
            alpha += weight * colour[3];
            area += weight;
        }
    }
    const bool transparent = alpha <= 0;
    const auto& sum = transparent ? plain : opaque;
    const float total = transparent ? area : alpha;
    return {sum[0] / total, sum[1] / total, sum[2] / total, alpha / area};
}

}  // namespace

Image halve_image(const Image& image) {
    Image half;
    half.width = std::max(image.width / 2, 1u);
    half.height = std::max(image.height / 2, 1u);
    half.rgba.resize(std::size_t{half.width} * half.height * 4);
    std::vector<Box1d> columns;
    columns.reserve(half.width);
    for (std::uint32_t x = 0; x < half.width; ++x)
        columns.emplace_back(x, image.width, half.width);
    tbb::parallel_for(std::uint32_t{0}, half.height, [&](std::uint32_t y) {
        const Box1d rows(y, image.height, half.height);
        for (std::uint32_t x = 0; x < half.width; ++x) {
            const std::uint32_t colour = rgba8_from_linear(average(image, columns[x], rows));
            for (std::size_t i = 0; i < 4; ++i)
                half.rgba[(std::size_t{y} * half.width + x) * 4 + i] = static_cast<std::uint8_t>(colour >> (8 * i));
        }
    });
    return half;
}

std::vector<std::byte> build_mip_chain(const Image& image) {
    std::vector<std::byte> texels;
    const auto append = [&](const Image& level) {
        const auto bytes = std::as_bytes(std::span(level.rgba));
        texels.insert(texels.end(), bytes.begin(), bytes.end());
    };
    append(image);
    for (Image level = image; level.width > 1 || level.height > 1;) {
        level = halve_image(level);
        append(level);
    }
    return texels;
}

}  // namespace splice
