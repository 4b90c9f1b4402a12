// Colours are averaged in linear light over the surface that a surfel stands for.
#include "preprocess/model_format/srgb.h"
#include "preprocess/surfel/surfel_colour.h"
#include "tests/surfel/surfel_fixture.h"

#include <catch2/catch.hpp>

#include <cmath>
#include <limits>

using namespace splice;
using namespace splice::test;

namespace {

// A unit square, uv = (x, 1 - y), with a texture of `texels` squared, black and white in turn.
IndexedMesh chequered_square(std::uint32_t texels) {
    IndexedMesh mesh = mesh_of({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, {{0, 1, 2}, {0, 2, 3}});
    for (std::size_t c = 0; c < 6; ++c) {
        const Vec3f& p = mesh.positions[mesh.triangles[c / 3][c % 3]];
        mesh.corner_uvs.emplace_back(p.x() + 0.5f, 0.5f - p.y());
    }
    Image image{texels, texels, {}};
    for (std::uint32_t y = 0; y < texels; ++y) {
        for (std::uint32_t x = 0; x < texels; ++x) {
            const std::uint8_t value = (x + y) % 2 == 0 ? 255 : 0;
            image.rgba.insert(image.rgba.end(), {value, value, value, 255});
        }
    }
    mesh.images.push_back(image);
    mesh.materials = {{"chequered", kWhite, 0}};
    return mesh;
}

int channel(std::uint32_t rgba, int index) {
    return static_cast<int>((rgba >> (8 * index)) & 0xffu);
}

SurfelSet sample(const IndexedMesh& mesh, double h) {
    SamplingOptions options;
    options.h_min = options.h_max = h;
    return sample_patches(mesh, one_patch(mesh), options);
}

}  // namespace

TEST_CASE("surfels smaller than the checks are black or white", "[surfel]") {
    const SurfelSet set = sample(chequered_square(4), 0.01);
    std::size_t checked = 0;
    for (const auto& surfel : set.surfels) {
        // Bilinear filtering blends within half a texel of an edge; look at the middles only.
        const float u = (surfel.position.x() + 0.5f) * 4, v = (0.5f - surfel.position.y()) * 4;
        if (std::abs(u - std::floor(u) - 0.5f) > 0.1f || std::abs(v - std::floor(v) - 0.5f) > 0.1f) continue;
        const bool white = (static_cast<int>(u) + static_cast<int>(v)) % 2 == 0;
        CHECK((white ? channel(surfel.colour, 0) > 215 : channel(surfel.colour, 0) < 130));
        ++checked;
    }
    CHECK(checked > 100);
}

TEST_CASE("surfels larger than the checks have the mean colour in linear light", "[surfel]") {
    // A disk's colour is the mean over its cells. Cells little larger than a check of 1/64 see more of one colour than
    // of the other; many checks a cell leave rounding.
    const int grey = srgb_from_linear(0.5f);
    for (const std::uint32_t texels : {64u, 256u}) {
        for (const auto& surfel : sample(chequered_square(texels), 0.15).surfels) {
            for (int k = 0; k < 3; ++k)
                CHECK(std::abs(channel(surfel.colour, k) - grey) <= (texels == 64 ? 10 : 2));
            CHECK(channel(surfel.colour, 3) == 255);
        }
    }
}

TEST_CASE("textures wrap", "[surfel]") {
    IndexedMesh mesh = chequered_square(4);
    const SurfelSet before = sample(mesh, 0.02);
    for (auto& uv : mesh.corner_uvs)
        uv += Vec2f(3, -5);
    const SurfelSet after = sample(mesh, 0.02);
    REQUIRE(before.surfels.size() == after.surfels.size());
    for (std::size_t s = 0; s < before.surfels.size(); ++s) {
        CHECK(std::abs(channel(before.surfels[s].colour, 0) - channel(after.surfels[s].colour, 0)) <= 2);
    }
}

TEST_CASE("material, vertex colour and texture multiply", "[surfel]") {
    IndexedMesh mesh = mesh_of({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}});
    mesh.materials = {{"red", 0xff0000ffu, kNoImage}};
    for (const auto& surfel : sample(mesh, 0.1).surfels)
        CHECK(surfel.colour == 0xff0000ffu);
    mesh.materials[0].diffuse = kWhite;
    mesh.corner_colours.assign(3, 0xff40a0c0u);
    for (const auto& surfel : sample(mesh, 0.1).surfels)
        CHECK(surfel.colour == 0xff40a0c0u);
    mesh.materials[0].diffuse = 0xff0000ffu;
    for (const auto& surfel : sample(mesh, 0.1).surfels)
        CHECK(surfel.colour == 0xff0000c0u);
}

TEST_CASE("transparent texels do not darken their neighbours", "[surfel]") {
    IndexedMesh mesh = chequered_square(256);
    auto& rgba = mesh.images[0].rgba;
    for (std::size_t i = 0; i < rgba.size(); i += 4)
        rgba[i + 3] = rgba[i];  // black texels become transparent
    for (const auto& surfel : sample(mesh, 0.15).surfels) {
        CHECK(channel(surfel.colour, 0) >= 254);
        CHECK(std::abs(channel(surfel.colour, 3) - 128) <= 2);
    }
}

TEST_CASE("unusable texture coordinates and images fall back to white", "[surfel]") {
    IndexedMesh mesh = chequered_square(4);
    mesh.corner_uvs.assign(6, Vec2f(std::numeric_limits<float>::quiet_NaN(), 1e30f));
    for (const auto& surfel : sample(mesh, 0.1).surfels)
        CHECK(surfel.colour == kWhite);
    mesh.corner_uvs.assign(6, Vec2f(1e30f, -1e30f));
    CHECK_FALSE(sample(mesh, 0.1).surfels.empty());
    mesh.images[0] = {};
    for (const auto& surfel : sample(mesh, 0.1).surfels)
        CHECK(surfel.colour == kWhite);
}
