// What drawing takes, as far as a choice between representations needs to know: a model, linear in what is drawn.
#pragma once

#include <cstdint>

namespace splice {

/// Microseconds.
struct DrawCosts {
    double triangle;        // its vertices included
    double triangle_pixel;  // a pixel that triangles cover
    double splat;           // a surfel or an ellipse: set up, found by its tiles
    double splat_pixel;     // a pixel that surfels cover, all that overlap there
    double frame_pixel;     // a pixel of the picture, whatever is drawn
};

/// Of software rasterisation (lavapipe, two cores), surfels by tiles. Captures use it on every device, so that they
/// repeat.
inline constexpr DrawCosts kSoftwareCosts{
    .triangle = 0.25, .triangle_pixel = 0.02, .splat = 0.13, .splat_pixel = 0.18, .frame_pixel = 0.03};

}  // namespace splice
