// How a scene is shown: what scene files say in "render" and "comparison" (docs/scene_format.md). Plain data.
#pragma once

#include "engine/scene/backend.h"
#include "engine/scene/draw_list.h"
#include "engine/scene/kernel.h"
#include "engine/scene/merged_surfels.h"
#include "engine/scene/named.h"
#include "engine/scene/shading.h"
#include "engine/scene/shown.h"
#include "engine/scene/view.h"

#include <cstdint>

namespace splice {

struct SceneLook {
    View view = View::kShaded;
    Shown shown = Shown::kHybrid;
    Backend backend = Backend::kAuto;
    Sides sides = Sides::kAsBaked;
    double epsilon_scale = 1;
    bool prefilter = true;
    std::uint32_t antialias = 1;  // samples along each side of a pixel
    Shading shading = Shading::kSurfel;
    double merge_px = kMergePixels;  // pixels, 0 to kMostMergePixels; see merged_surfels.h
    double tau = 0;                  // pixels, 0 to kMostTau; see lod_cut.h
    Kernel kernel = {};
};

/// Two looks at the same scene, of windows.
enum class Comparison { kOff, kSideBySide, kWipe };
inline constexpr Names<Comparison, 3> kComparisonNames{
    {{Comparison::kOff, "off"}, {Comparison::kSideBySide, "side-by-side"}, {Comparison::kWipe, "wipe"}}};

struct SceneComparison {
    Comparison kind = Comparison::kOff;
    double wipe = 0.5;  // share of the picture that is left of the line
    SceneLook right;    // the left one is the scene's
};

}  // namespace splice
