#include "preprocess/model_format/srgb.h"

#include <catch2/catch.hpp>

using namespace splice;

TEST_CASE("sRGB bytes survive the way through linear light") {
    for (unsigned i = 0; i < 256; ++i)
        CHECK(srgb_from_linear(linear_from_srgb(static_cast<std::uint8_t>(i))) == i);
    for (const std::uint32_t colour : {0x00000000u, 0xffffffffu, 0x80402010u, 0x12345678u})
        CHECK(rgba8_from_linear(linear_from_rgba8(colour)) == colour);
}

TEST_CASE("sRGB decoding agrees with the standard's values") {
    CHECK(linear_from_srgb(0) == 0.0f);
    CHECK(linear_from_srgb(255) == 1.0f);
    CHECK(linear_from_srgb(10) == Approx(0.0030352698).epsilon(1e-5));
    CHECK(linear_from_srgb(128) == Approx(0.2158605).epsilon(1e-5));
    CHECK(srgb_from_linear(0.5f) == 188);
    CHECK(srgb_from_linear(-1) == 0);
    CHECK(srgb_from_linear(7) == 255);
}

TEST_CASE("colours multiply in linear light") {
    CHECK(multiply_colours(0xffffffffu, 0x80402010u) == 0x80402010u);
    CHECK(multiply_colours(0xff00ff00u, 0xff0000ffu) == 0xff000000u);
    // 188 is 0.5029 of full light, its square 0.2529 is 138
    CHECK(multiply_colours(0xffbcbcbcu, 0xffbcbcbcu) == 0xff8a8a8au);
}
