// What drawing takes: a model, linear in what is drawn, for choices between representations and for frame times that
// are to be held. Its constants are fitted to measured frames (engine/capture/calibrate.h).
#pragma once

#include <cstdint>
#include <span>

namespace splice {

/// Microseconds.
struct DrawCosts {
    double frame = 0;           // whatever is drawn
    double frame_pixel = 0;     // a pixel of the picture, whatever is drawn
    double triangle = 0;        // its vertices included
    double triangle_hit = 0;    // one that meets a pixel's centre
    double triangle_pixel = 0;  // a pixel of a triangle patch
    double splat = 0;           // a surfel or an ellipse: set up, found by its tiles
    double splat_pixel = 0;     // a pixel of a surfel patch, all that overlap there
    friend bool operator==(const DrawCosts&, const DrawCosts&) = default;
};

/// Of software rasterisation (lavapipe, two cores), surfels by tiles: a fit of `splice-bench costs` on a busy machine,
/// times 0.87, as frames were faster when it was idle. Captures use it on every device, so that they repeat.
inline constexpr DrawCosts kSoftwareCosts{.frame = 500,
                                          .frame_pixel = 0.031,
                                          .triangle = 0.086,
                                          .triangle_hit = 0.21,
                                          .triangle_pixel = 0.033,
                                          .splat = 0.22,
                                          .splat_pixel = 0.088};

/// What there is to draw in a frame. Pixels and hits are estimates: pixels of a patch half of its area as it is seen
/// face on, hits no more than pixels.
struct DrawLoad {
    double frame_pixels = 0;
    double triangles = 0, triangle_hits = 0, triangle_pixels = 0;
    double splats = 0, splat_pixels = 0;
    DrawLoad& operator+=(const DrawLoad& other);
};

double predicted_ms(const DrawCosts& costs, const DrawLoad& load);

struct CostSample {
    DrawLoad load;
    double ms = 0;  // measured, above 0
};

/// The costs, none below 0, with which the sum of the squares of the relative errors is least. Costs of what no sample
/// has are 0.
DrawCosts fit_costs(std::span<const CostSample> samples);

}  // namespace splice
