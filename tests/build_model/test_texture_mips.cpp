#include "preprocess/build_model/texture_mips.h"
#include "preprocess/model_format/srgb.h"

#include <catch2/catch.hpp>

using namespace splice;

namespace {

Image image_of(std::uint32_t width, std::uint32_t height, const std::vector<std::uint32_t>& colours) {
    Image image{width, height, {}};
    for (const std::uint32_t colour : colours)
        for (unsigned shift = 0; shift < 32; shift += 8)
            image.rgba.push_back(static_cast<std::uint8_t>(colour >> shift));
    return image;
}

std::uint32_t texel(const Image& image, std::size_t i) {
    return image.rgba[4 * i] | std::uint32_t{image.rgba[4 * i + 1]} << 8 | std::uint32_t{image.rgba[4 * i + 2]} << 16 |
           std::uint32_t{image.rgba[4 * i + 3]} << 24;
}

constexpr std::uint32_t kBlack = 0xff000000u;

}  // namespace

TEST_CASE("mips average in linear light") {
    const Image half = halve_image(image_of(2, 2, {kWhite, kBlack, kBlack, kWhite}));
    CHECK(half.width == 1);
    CHECK(half.height == 1);
    CHECK(texel(half, 0) == 0xffbcbcbcu);  // 188 is half of full light; 128 would be the average of the bytes
}

TEST_CASE("an odd side is covered in fractions, none of it lost") {
    const Image half = halve_image(image_of(3, 1, {kWhite, kBlack, kBlack}));
    REQUIRE(half.width == 1);
    CHECK(linear_from_rgba8(texel(half, 0))[0] == Approx(1.0 / 3).margin(0.005));
    const Image two = halve_image(image_of(5, 1, {kBlack, kBlack, kWhite, kBlack, kBlack}));
    REQUIRE(two.width == 2);
    for (std::size_t i = 0; i < 2; ++i)
        CHECK(linear_from_rgba8(texel(two, i))[0] == Approx(0.2).margin(0.005));
}

TEST_CASE("transparent texels give no colour") {
    const Image half = halve_image(image_of(2, 1, {0x000000ffu, 0xff00ff00u}));  // invisible red, green
    CHECK(texel(half, 0) == 0x8000ff00u);
    const Image invisible = halve_image(image_of(2, 1, {0x000000ffu, 0x000000ffu}));
    CHECK(texel(invisible, 0) == 0x000000ffu);
}

TEST_CASE("a chain goes down to one texel") {
    const std::vector<std::byte> chain = build_mip_chain(image_of(5, 2, std::vector<std::uint32_t>(10, 0xff336699u)));
    CHECK(chain.size() == 4 * (5 * 2 + 2 * 1 + 1 * 1));
    for (std::size_t i = 0; i < chain.size(); i += 4)
        CHECK(chain[i] == std::byte{0x99});
    CHECK(build_mip_chain(image_of(1, 1, {kWhite})).size() == 4);
}
