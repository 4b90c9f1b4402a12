#include "preprocess/model_format/surfel_extent.h"

#include <catch2/catch.hpp>

#include <cmath>

using namespace splice;

TEST_CASE("what a surfel's extent stores reaches no less far, and hardly farther") {
    for (const float radius : {1e-4f, 0.004f, 1.5f}) {
        for (float share = 2.5e-4f; share < 1; share *= 1.07f) {
            const SurfelExtent extent{share * radius, 0.5f * share * radius, 2 * share * radius};
            const SurfelExtent stored = decode_extent(encode_extent(extent, radius), radius);
            CAPTURE(radius, share);
            CHECK(stored.above >= extent.above * 0.99999f);
            CHECK(stored.above <= extent.above * 1.33f);
            CHECK(stored.below >= extent.below * 0.99999f);
            CHECK((stored.below <= extent.below * 1.33f || stored.below <= radius * std::exp2(-11.99f)));
            CHECK((stored.epsilon >= extent.epsilon * 0.99999f));
            CHECK((stored.epsilon <= extent.epsilon * 1.2f || stored.epsilon <= radius * std::exp2(-5.74f)));
        }
    }
}

TEST_CASE("the ends of a surfel's extent") {
    CHECK(encode_extent({}, 1) == 0);
    CHECK(encode_extent({1, 1, 1}, 0) == 0);
    const SurfelExtent none = decode_extent(0, 1);
    CHECK(none.above == 0);
    CHECK(none.below == 0);
    CHECK(none.epsilon == 0);
    const SurfelExtent all = decode_extent(encode_extent({1, 1, 1}, 1), 1);
    CHECK(all.above == 1);
    CHECK(all.below == 1);
    CHECK(all.epsilon == 1);
    const SurfelExtent most = decode_extent(0xffff, 1);
    CHECK(most.above == 1);
    CHECK(most.epsilon == Approx(std::exp2(9.75)));
}
