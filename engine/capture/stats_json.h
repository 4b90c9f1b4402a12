// splice-capture --stats.
#pragma once

#include "engine/capture/capture.h"

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

}  // namespace splice
