#include "engine/scene/draw_costs.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace splice {

namespace {

constexpr std::size_t kTerms = 7;
using Terms = std::array<double, kTerms>;

// In the order of DrawCosts.
Terms terms_of(const DrawLoad& load) {
    return {1,           load.frame_pixels, load.triangles, load.triangle_hits, load.triangle_pixels,
            load.splats, load.splat_pixels};
}

}  // namespace

DrawLoad& DrawLoad::operator+=(const DrawLoad& other) {
    frame_pixels += other.frame_pixels;
    triangles += other.triangles;
    triangle_hits += other.triangle_hits;
    triangle_pixels += other.triangle_pixels;
    splats += other.splats;
    splat_pixels += other.splat_pixels;
    return *this;
}

double predicted_ms(const DrawCosts& costs, const DrawLoad& load) {
    return 1e-3 * (costs.frame + costs.frame_pixel * load.frame_pixels + costs.triangle * load.triangles +
                   costs.triangle_hit * load.triangle_hits + costs.triangle_pixel * load.triangle_pixels +
                   costs.splat * load.splats + costs.splat_pixel * load.splat_pixels);
}

// Coordinate descent on the normal equations: each cost in turn takes its best value, not below 0, which comes to the
// one minimum that a convex problem has. Columns are scaled to unit length, so that few rounds suffice.
DrawCosts fit_costs(std::span<const CostSample> samples) {
    std::array<Terms, kTerms> squares{};
    Terms right{}, scale{}, x{};
    for (const CostSample& sample : samples) {
        Terms row = terms_of(sample.load);
        for (double& term : row)
            term /= sample.ms;
        for (std::size_t i = 0; i < kTerms; ++i) {
            right[i] += row[i];
            for (std::size_t j = 0; j < kTerms; ++j)
                squares[i][j] += row[i] * row[j];
        }
    }
    for (std::size_t i = 0; i < kTerms; ++i)
        scale[i] = squares[i][i] > 0 ? 1 / std::sqrt(squares[i][i]) : 0;
    constexpr int kRounds = 20'000;
    for (int round = 0; round < kRounds; ++round)
        for (std::size_t i = 0; i < kTerms; ++i) {
            double residual = right[i] * scale[i];
            for (std::size_t j = 0; j < kTerms; ++j)
                if (j != i) residual -= squares[i][j] * scale[i] * scale[j] * x[j];
            x[i] = scale[i] > 0 ? std::max(residual, 0.0) : 0;
        }
    for (std::size_t i = 0; i < kTerms; ++i)
        x[i] *= 1e3 * scale[i];
    return {x[0], x[1], x[2], x[3], x[4], x[5], x[6]};
}

}  // namespace splice
