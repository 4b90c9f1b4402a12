#include "preprocess/mesh/shape_builder.h"
#include "preprocess/mesh/shapes.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace splice::shapes {

SourceMesh checkerboard(std::uint32_t tiles, std::uint32_t cells) {
    tiles = std::max(tiles, 1u);
    cells = std::max(cells, 1u);
    SourceMesh mesh = empty_mesh();
    for (std::uint32_t j = 0; j <= cells; ++j) {
        for (std::uint32_t i = 0; i <= cells; ++i) {
            add_vertex(mesh, {static_cast<double>(i) / cells - 0.5, static_cast<double>(j) / cells - 0.5, 0});
        }
    }
    VertexAttributes attributes;
    for (const Vec3d& p : mesh.positions)
        attributes.uvs.push_back(Vec2d(p.x() + 0.5, 0.5 - p.y()).cast<float>());
    for (std::uint32_t j = 0; j < cells; ++j) {
        for (std::uint32_t i = 0; i < cells; ++i) {
            const std::uint32_t a = j * (cells + 1) + i;
            add_polygon(mesh, {a, a + 1, a + cells + 2, a + cells + 1});
        }
    }
    expand_vertex_attributes(attributes, mesh);

    constexpr std::uint32_t kTexelsPerTile = 16;
    Image image;
    image.width = image.height = tiles * kTexelsPerTile;
    image.rgba.reserve(std::size_t{4} * image.width * image.height);
    for (std::uint32_t y = 0; y < image.height; ++y) {
        for (std::uint32_t x = 0; x < image.width; ++x) {
            const bool white = (x / kTexelsPerTile + y / kTexelsPerTile) % 2 == 0;
            image.rgba.insert(image.rgba.end(), 3, white ? 240 : 16);
            image.rgba.push_back(255);
        }
    }
    mesh.images.push_back(std::move(image));
    MeshMaterial material;
    material.name = "checkerboard";
    material.image = 0;
    mesh.materials.push_back(std::move(material));
    return mesh;
}

namespace {

/// A closed curve around the z axis, one point for each of equally spaced directions.
struct Loop {
    enum class Outline { kCircle, kSquare } outline;
    double size;  // radius, or half the side
    double z;
};

Vec3d loop_point(const Loop& loop, double azimuth) {
    const double x = std::cos(azimuth), y = std::sin(azimuth);
    const double reach = loop.outline == Loop::Outline::kCircle ? 1.0 : 1 / std::max(std::abs(x), std::abs(y));
    return {loop.size * reach * x, loop.size * reach * y, loop.z};
}

}  // namespace

SourceMesh machined_part(std::uint32_t segments) {
    segments = (std::max(segments, 8u) + 7) / 8 * 8;  // so that the square's corners are points of the loop
    constexpr double kHalf = 1, kBottom = -0.4, kTop = 0.4, kBossTop = 0.7, kBoss = 0.7, kBore = 0.4, kChamfer = 0.06;
    using enum Loop::Outline;
    // From the top of the bore outwards, down the outside, and up through the bore again.
    const std::vector<Loop> loops = {
        {kCircle, kBore + kChamfer, kBossTop}, {kCircle, kBoss - kChamfer, kBossTop},
        {kCircle, kBoss, kBossTop - kChamfer}, {kCircle, kBoss, kTop},
        {kSquare, kHalf - kChamfer, kTop},     {kSquare, kHalf, kTop - kChamfer},
        {kSquare, kHalf, kBottom + kChamfer},  {kSquare, kHalf - kChamfer, kBottom},
        {kCircle, kBore + kChamfer, kBottom},  {kCircle, kBore, kBottom + kChamfer},
        {kCircle, kBore, kBossTop - kChamfer},
    };
    SourceMesh mesh = empty_mesh();
    for (const Loop& loop : loops) {
        for (std::uint32_t i = 0; i < segments; ++i)
            add_vertex(mesh, loop_point(loop, 2 * std::numbers::pi * i / segments));
    }
    const auto count = static_cast<std::uint32_t>(loops.size());
    for (std::uint32_t l = 0; l < count; ++l) {
        const std::uint32_t here = l * segments, there = (l + 1) % count * segments;
        for (std::uint32_t i = 0; i < segments; ++i) {
            const std::uint32_t next = (i + 1) % segments;
            add_polygon(mesh, {here + i, there + i, there + next, here + next});
        }
    }
    return mesh;
}

}  // namespace splice::shapes
