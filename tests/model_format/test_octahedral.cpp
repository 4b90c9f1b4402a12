#include "preprocess/model_format/octahedral.h"

#include <catch2/catch.hpp>

#include <cmath>

using namespace splice;

TEST_CASE("octahedral normals are right to 0.004 degrees") {
    double largest = 0;
    constexpr int steps = 200;
    for (int i = 0; i <= steps; ++i) {
        for (int j = 0; j < steps; ++j) {
            const double theta = M_PI * i / steps, phi = 2 * M_PI * j / steps;
            const double n[3] = {std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
            const auto decoded = decode_octahedral(
                encode_octahedral(static_cast<float>(n[0]), static_cast<float>(n[1]), static_cast<float>(n[2])));
            double difference = 0;
            for (std::size_t k = 0; k < 3; ++k)
                difference += (n[k] - static_cast<double>(decoded[k])) * (n[k] - static_cast<double>(decoded[k]));
            largest = std::max(largest, std::sqrt(difference));
        }
    }
    CHECK(largest * 180 / M_PI < 0.004);
}

TEST_CASE("the axes are exact") {
    for (int axis = 0; axis < 3; ++axis) {
        for (const float sign : {-1.0f, 1.0f}) {
            float n[3] = {0, 0, 0};
            n[axis] = sign;
            const auto decoded = decode_octahedral(encode_octahedral(n[0], n[1], n[2]));
            for (int k = 0; k < 3; ++k)
                CHECK(decoded[static_cast<std::size_t>(k)] == n[k]);
        }
    }
}
