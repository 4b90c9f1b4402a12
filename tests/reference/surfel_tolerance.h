// How far a surfel may stray from the surface that it was sampled from, per pixel.
#pragma once

#include "preprocess/model_format/model.h"
#include "tests/reference/metrics.h"
#include "tests/reference/reference_scene.h"

namespace splice::reference {

/// Largest 2 epsilon + spacing, and largest projected radius, over the surfels whose solid's bounding circle (plus the
/// 1 px prefilter) holds the pixel's centre and which lie at the reference's depth there: not the surfels behind it,
/// which are hidden and may be coarser. A pixel that the reference leaves empty takes every surfel that reaches it.
/// `epsilon_scale` is the frame's; format::Surfel::epsilon is both the unscaled epsilon and the spacing. Pixels that no
/// surfel reaches get `floor`, the rounding of a depth buffer in unit-box units, as do all others at least. Results are
/// in the view's units.
Tolerance surfel_tolerance(const ModelView& model, const ReferenceView& view, const DepthImage& reference,
                           float epsilon_scale = 1, float floor = 1e-5f);

}  // namespace splice::reference
