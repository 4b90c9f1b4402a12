// The cost model, without a device.
#include "engine/scene/draw_costs.h"

#include <catch2/catch.hpp>

#include <random>
#include <vector>

using namespace splice;

namespace {

constexpr DrawCosts kTrue{.frame = 800,
                          .frame_pixel = 0.02,
                          .triangle = 0.1,
                          .triangle_hit = 0.3,
                          .triangle_pixel = 0.05,
                          .splat = 0.15,
                          .splat_pixel = 0.2};

std::vector<CostSample> samples(double noise) {
    std::mt19937 random(9);
    std::uniform_real_distribution<double> share(0, 1), factor(1 - noise, 1 + noise);
    std::vector<CostSample> all;
    for (int i = 0; i < 60; ++i) {
        DrawLoad load{.frame_pixels = 1e6 * share(random)};
        if (i % 3 == 0)
            load.triangles = 2e5 * share(random), load.triangle_hits = load.triangles * share(random),
            load.triangle_pixels = 5e5 * share(random);
        if (i % 3 == 1) load.splats = 2e5 * share(random), load.splat_pixels = 5e5 * share(random);
        all.push_back({load, predicted_ms(kTrue, load) * factor(random)});
    }
    return all;
}

}  // namespace

TEST_CASE("costs are found again from the frames that they predict") {
    const DrawCosts costs = fit_costs(samples(0));
    CHECK(costs.frame == Approx(kTrue.frame).epsilon(1e-3));
    CHECK(costs.frame_pixel == Approx(kTrue.frame_pixel).epsilon(1e-3));
    CHECK(costs.triangle == Approx(kTrue.triangle).epsilon(1e-3));
    CHECK(costs.triangle_hit == Approx(kTrue.triangle_hit).epsilon(1e-3));
    CHECK(costs.triangle_pixel == Approx(kTrue.triangle_pixel).epsilon(1e-3));
    CHECK(costs.splat == Approx(kTrue.splat).epsilon(1e-3));
    CHECK(costs.splat_pixel == Approx(kTrue.splat_pixel).epsilon(1e-3));
}

TEST_CASE("frames that vary by a tenth are predicted to a tenth") {
    const DrawCosts costs = fit_costs(samples(0.1));
    for (const CostSample& sample : samples(0)) {
        CHECK(predicted_ms(costs, sample.load) < 1.1 * sample.ms);
        CHECK(predicted_ms(costs, sample.load) > 0.9 * sample.ms);
    }
}

TEST_CASE("no cost is below 0, and what no frame has costs nothing") {
    // The more triangles the faster, which no cost explains.
    std::vector<CostSample> odd;
    for (int i = 1; i <= 10; ++i)
        odd.push_back({{.frame_pixels = 1000, .triangles = 1000.0 * i}, 20.0 - i});
    const DrawCosts costs = fit_costs(odd);
    CHECK(costs.triangle == 0);
    CHECK(costs.splat == 0);
    CHECK(costs.frame + costs.frame_pixel > 0);
}
