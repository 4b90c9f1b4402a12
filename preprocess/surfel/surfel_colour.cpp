// Mip pyramids after Williams 1983, averaged in linear light.
#include "preprocess/surfel/surfel_colour.h"

#include "preprocess/model_format/srgb.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <tuple>

namespace splice {
namespace {

LinearColour decode(const std::uint8_t* rgba) {
    const float alpha = static_cast<float>(rgba[3]) / 255.0f;
    return {linear_from_srgb(rgba[0]) * alpha, linear_from_srgb(rgba[1]) * alpha, linear_from_srgb(rgba[2]) * alpha,
            alpha};
}

LinearColour decode(std::uint32_t rgba) {
    const std::array<std::uint8_t, 4> bytes = {static_cast<std::uint8_t>(rgba), static_cast<std::uint8_t>(rgba >> 8),
                                               static_cast<std::uint8_t>(rgba >> 16),
                                               static_cast<std::uint8_t>(rgba >> 24)};
    return decode(bytes.data());
}

// Both weighted by alpha, and so is the product.
LinearColour multiply(const LinearColour& a, const LinearColour& b) {
    return a * b;
}

}  // namespace

SurfaceColour::SurfaceColour(const IndexedMesh& mesh) : mesh_(mesh), pyramids_(mesh.images.size()) {
    if (mesh.corner_uvs.empty()) return;
    for (std::size_t i = 0; i < mesh.images.size(); ++i) {
        const Image& image = mesh.images[i];
        if (image.width == 0 || image.height == 0) continue;
        const std::uint8_t* finer = image.rgba.data();
        std::uint32_t width = image.width, height = image.height;
        while (width > 1 || height > 1) {
            Level level{std::max(1u, width / 2), std::max(1u, height / 2), {}};
            level.rgba.resize(std::size_t{4} * level.width * level.height);
            for (std::uint32_t row = 0; row < level.height; ++row) {
                for (std::uint32_t column = 0; column < level.width; ++column) {
                    LinearColour sum = LinearColour::Zero();
                    for (const auto y : {2 * row, 2 * row + 1}) {
                        for (const auto x : {2 * column, 2 * column + 1}) {
                            sum += decode(finer +
                                          4 * (std::size_t{std::min(y, height - 1)} * width + std::min(x, width - 1)));
                        }
                    }
                    const std::uint32_t mean = encode(sum / 4);
                    std::uint8_t* out = level.rgba.data() + 4 * (std::size_t{row} * level.width + column);
                    for (unsigned channel = 0; channel < 4; ++channel)
                        out[channel] = static_cast<std::uint8_t>(mean >> (8 * channel));
                }
            }
            pyramids_[i].push_back(std::move(level));
            finer = pyramids_[i].back().rgba.data();
            width = pyramids_[i].back().width;
            height = pyramids_[i].back().height;
        }
    }
}

bool SurfaceColour::varies(std::uint32_t material) const {
    if (!mesh_.corner_colours.empty()) return true;
    return material < mesh_.materials.size() && mesh_.materials[material].image < mesh_.images.size() &&
           !mesh_.corner_uvs.empty();
}

bool SurfaceColour::textured(std::uint32_t triangle) const {
    const std::uint32_t material = mesh_.triangle_material.empty() ? 0 : mesh_.triangle_material[triangle];
    if (material >= mesh_.materials.size() || mesh_.corner_uvs.empty()) return false;
    const auto image = mesh_.materials[material].image;
    return image < mesh_.images.size() && mesh_.images[image].width > 0 && mesh_.images[image].height > 0;
}

LinearColour SurfaceColour::at(std::uint32_t triangle, const Vec3f& barycentric, float footprint) const {
    const std::uint32_t material = mesh_.triangle_material.empty() ? 0 : mesh_.triangle_material[triangle];
    LinearColour colour = LinearColour::Ones();
    if (material < mesh_.materials.size()) {
        colour = decode(mesh_.materials[material].diffuse);
        const auto image = mesh_.materials[material].image;
        if (image < mesh_.images.size() && !mesh_.corner_uvs.empty() && mesh_.images[image].width > 0 &&
            mesh_.images[image].height > 0) {
            colour = multiply(colour, texture(image, triangle, barycentric, footprint));
        }
    }
    if (!mesh_.corner_colours.empty()) {
        LinearColour vertex = LinearColour::Zero();
        for (int k = 0; k < 3; ++k)
            vertex +=
                barycentric[k] * decode(mesh_.corner_colours[3 * std::size_t{triangle} + static_cast<std::size_t>(k)]);
        colour = multiply(colour, vertex);
    }
    return colour;
}

LinearColour SurfaceColour::texture(std::uint32_t image, std::uint32_t triangle, const Vec3f& barycentric,
                                    float footprint) const {
    const Image& base = mesh_.images[image];
    const auto& v = mesh_.triangles[triangle];
    const Vec2f* corner = &mesh_.corner_uvs[3 * std::size_t{triangle}];
    const Vec2f uv = barycentric[0] * corner[0] + barycentric[1] * corner[1] + barycentric[2] * corner[2];
    if (!uv.allFinite()) return LinearColour::Ones();

    // Texels a side of the footprint, from the ratio of the triangle's areas in the image and on the surface.
    const Vec2f e1 = corner[1] - corner[0], e2 = corner[2] - corner[0];
    const float texels =
        std::abs(e1.x() * e2.y() - e1.y() * e2.x()) * static_cast<float>(base.width) * static_cast<float>(base.height);
    const float surface =
        (mesh_.positions[v[1]] - mesh_.positions[v[0]]).cross(mesh_.positions[v[2]] - mesh_.positions[v[0]]).norm();
    const float side = surface > 0 ? footprint * std::sqrt(texels / surface) : 0.0f;
    const auto& pyramid = pyramids_[image];
    const float level = side > 1 ? std::min(std::floor(std::log2(side)), static_cast<float>(pyramid.size())) : 0.0f;
    const auto index = static_cast<std::size_t>(level);
    const std::uint32_t width = index == 0 ? base.width : pyramid[index - 1].width;
    const std::uint32_t height = index == 0 ? base.height : pyramid[index - 1].height;
    const std::uint8_t* rgba = index == 0 ? base.rgba.data() : pyramid[index - 1].rgba.data();

    // Bilinear; texel centres at half-integers; wrapped.
    const auto wrapped = [](float coordinate, std::uint32_t size) {
        const float whole = (coordinate - std::floor(coordinate)) * static_cast<float>(size) - 0.5f;
        const float low = std::floor(whole);
        const auto first =
            static_cast<std::uint32_t>(low < 0 ? size - 1 : std::min(static_cast<std::uint32_t>(low), size - 1));
        return std::tuple{first, first + 1 == size ? 0u : first + 1, whole - low};
    };
    const auto [x0, x1, fx] = wrapped(uv.x(), width);
    const auto [y0, y1, fy] = wrapped(uv.y(), height);
    const auto texel = [&, w = width](std::uint32_t x, std::uint32_t y) {
        return decode(rgba + 4 * (std::size_t{y} * w + x));
    };
    return (1 - fy) * ((1 - fx) * texel(x0, y0) + fx * texel(x1, y0)) +
           fy * ((1 - fx) * texel(x0, y1) + fx * texel(x1, y1));
}

std::uint32_t SurfaceColour::encode(const LinearColour& colour) {
    const float scale = colour[3] > 0 ? 1 / colour[3] : 0.0f;
    return rgba8_from_linear({colour[0] * scale, colour[1] * scale, colour[2] * scale, colour[3]});
}

}  // namespace splice
