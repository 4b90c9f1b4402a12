// Frame times of the splat backends, interleaved in one process so that a busy machine hits all alike.
#pragma once

#include "engine/bench/frame/frame_report.h"
#include "engine/scene/backend.h"
#include "engine/scene/merged_surfels.h"
#include "engine/scene/shading.h"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace splice::bench {

struct FrameBenchOptions {
    std::string device = "auto";
    std::vector<std::filesystem::path> files;  // models, scenes or meshes
    std::vector<std::uint32_t> counts;  // disks of bumpy spheres, ten deep; without files and counts: 50 thousand,
                                        // 300 thousand, a million, and these from farther away
    std::vector<std::pair<std::uint32_t, std::uint32_t>> sizes = {{512, 512}};  // pixels
    std::vector<Backend> backends;                                              // none: all
    std::vector<Shading> shadings = {Shading::kSurfel};
    std::optional<double> points_below = {};  // pixels: CaptureSettings
    double merge_px = kMergePixels;           // CaptureSettings
    bool far = false;                         // those of `counts` from afar, too
    bool bare = false;                        // spheres: the baseline, too
    unsigned rounds = 15;                     // timed frames a variant
};

FrameReport bench_frame(const FrameBenchOptions& options);

}  // namespace splice::bench
