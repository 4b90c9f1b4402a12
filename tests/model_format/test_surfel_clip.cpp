#include "preprocess/model_format/surfel_clip.h"

#include <catch2/catch.hpp>

#include <cmath>

using namespace splice;

TEST_CASE("a clip line is stored no nearer to the centre, and hardly farther") {
    for (int direction = 0; direction < kClipDirections; ++direction) {
        for (float offset = 0; offset < 0.999f; offset += 0.013f) {
            const SurfelClip clip = decode_clip(encode_clip(direction, offset));
            CAPTURE(direction, offset);
            CHECK(clip.offset >= offset - 1e-6f);
            CHECK(clip.offset <= offset + 0.001f);
            const double turn = direction * 2 * std::numbers::pi / kClipDirections;
            CHECK(clip.x == Approx(std::cos(turn)).margin(1e-6));
            CHECK(clip.y == Approx(std::sin(turn)).margin(1e-6));
        }
    }
}

TEST_CASE("a whole disk has no clip line, and is what zero stands for") {
    for (const float offset : {1.0f, 0.9999f, 2.0f}) {
        CHECK(encode_clip(5, offset) == kNoClip);
    }
    CHECK(kNoClip == 0);
    const SurfelClip whole = decode_clip(kNoClip);
    CHECK(whole.x == 0);
    CHECK(whole.y == 0);
    CHECK(whole.offset == 1);
    CHECK(decode_clip(encode_clip(3, -1)).offset == 0);
}
