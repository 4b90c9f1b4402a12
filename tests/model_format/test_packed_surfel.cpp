#include "preprocess/model_format/half.h"
#include "preprocess/model_format/octahedral.h"
#include "preprocess/model_format/packed_surfel.h"
#include "preprocess/model_format/surfel_extent.h"

#include <catch2/catch.hpp>

#include <cstring>
#include <random>

using namespace splice;

namespace {

class RandomSurfels {
  public:
    format::Surfel next() {
        format::Surfel surfel{};
        for (float& coordinate : surfel.position)
            coordinate = share() - 0.5f;
        surfel.radius = half_at_least(std::exp2(-14 * share()));
        surfel.extent = static_cast<std::uint16_t>(random_() & 1023);
        surfel.normal = encode_octahedral(share() - 0.5f, share() - 0.5f, share() - 0.5f);
        for (std::uint8_t& channel : surfel.colour)
            channel = static_cast<std::uint8_t>(random_());
        return surfel;
    }

  private:
    float share() { return std::uniform_real_distribution<float>(0, 1)(random_); }

    std::mt19937 random_{3};
};

double angle_between(std::uint32_t a, std::uint32_t b) {
    const auto p = decode_octahedral(a), q = decode_octahedral(b);
    double squared = 0;
    for (std::size_t k = 0; k < 3; ++k)
        squared += std::pow(static_cast<double>(p[k]) - static_cast<double>(q[k]), 2);
    return 2 * std::asin(std::sqrt(squared) / 2) * 57.29578;
}

}  // namespace

TEST_CASE("packing keeps a surfel within the errors that it states") {
    RandomSurfels surfels;
    double worst_place = 0, worst_angle = 0;
    for (int i = 0; i < 20000; ++i) {
        const format::Surfel surfel = surfels.next();
        const format::PackedSurfel packed = pack_surfel(surfel);
        const format::Surfel back = unpack_surfel(packed, 7);
        for (int axis = 0; axis < 3; ++axis)
            worst_place = std::max(worst_place, std::abs(static_cast<double>(back.position[axis]) -
                                                         static_cast<double>(surfel.position[axis])));
        worst_angle = std::max(worst_angle, angle_between(surfel.normal, back.normal));
        CHECK(back.radius == surfel.radius);
        CHECK((back.extent & 1023) == surfel.extent);
        CHECK(std::memcmp(back.colour, surfel.colour, 3) == 0);
        CHECK(back.patch == 7);
        CHECK(back.clip == 0);
        const SurfelExtent extent = decode_extent(back.extent, 1);
        const float share = kPackedEpsilon + extent.above + extent.below;
        CHECK(extent.epsilon >= share * 0.9999f);
        CHECK(extent.epsilon <= share * 1.19f);
        const format::PackedSurfel again = pack_surfel(back);
        CHECK(std::memcmp(&again, &packed, sizeof packed) == 0);
    }
    CHECK(worst_place <= 0x1p-21 + 1e-7);
    CHECK(worst_angle < 0.16);
    CHECK(worst_angle > 0.05);  // it is 20 bits, after all
}

TEST_CASE("the corners of what can be packed are packed") {
    format::Surfel surfel{};
    surfel.position[0] = -0.5f;
    surfel.position[1] = 0.5f;
    for (const std::uint16_t radius : std::initializer_list<std::uint16_t>{0, 1, 0x3fff}) {
        surfel.radius = radius;
        surfel.normal = encode_octahedral(0, 0, -1);
        const format::Surfel back = unpack_surfel(pack_surfel(surfel), 0);
        CHECK(back.radius == radius);
        CHECK(back.position[0] == -0.5f);
        CHECK(back.position[1] == Approx(0.5f).margin(0x1p-20));
        CHECK(angle_between(surfel.normal, back.normal) < 0.01);
    }
    // Larger ones become the largest.
    surfel.radius = half_at_least(3);
    CHECK(unpack_surfel(pack_surfel(surfel), 0).radius == 0x3fff);
}
