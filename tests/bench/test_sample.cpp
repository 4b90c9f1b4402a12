#include "engine/bench/report/sample.h"

#include <catch2/catch.hpp>

#include <cmath>

using namespace splice::bench;

TEST_CASE("a sample is summed up by values that were measured") {
    const Sample five = summarise({50, 10, 40, 20, 30});
    CHECK(five.median == 30);
    CHECK(five.minimum == 10);
    CHECK(five.lower_quartile == 20);
    CHECK(five.upper_quartile == 40);
    const Sample one = summarise({7});
    CHECK(one.median == 7);
    CHECK(one.lower_quartile == 7);
    CHECK(one.upper_quartile == 7);
    CHECK(summarise({}).median == 0);
}

TEST_CASE("the growth exponent of a power law is its exponent") {
    for (const double exponent : {0.5, 1.0, 1.1, 2.0}) {
        std::vector<std::pair<double, double>> points;
        for (double n = 64; n <= 4096; n *= 4)
            points.emplace_back(n, 300 * std::pow(n, exponent));
        CHECK(growth_exponent(points) == Approx(exponent));
    }
    const std::vector<std::pair<double, double>> single{{64, 1}, {64, 2}};
    CHECK(std::isnan(growth_exponent(single)));
}
