// splice-capture --stats.
#pragma once

#include "engine/capture/capture.h"

#include <nlohmann/json_fwd.hpp>

#include <string>
#include <vector>

namespace splice {

struct CapturedFile {
    std::string path;
    FrameStats stats;
};

/// {device, frame_ms, passes: [{name, gpu_ms}], surfels_drawn, triangles_drawn, covered_pixels, overlap_mean} of the
/// last frame; of several, "frames" holds the same of each, with its "file".
std::string stats_json(const std::vector<CapturedFile>& files);

/// Microseconds, by the names of DrawCosts.
nlohmann::ordered_json costs_json(const DrawCosts& costs);

}  // namespace splice
