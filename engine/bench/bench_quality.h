// Frames against the oracle: how true they are, how fast, and whether the surface has holes.
#pragma once

#include "engine/bench/bench_models.h"
#include "engine/capture/capture.h"
#include "preprocess/build_model/build_model.h"

#include <nlohmann/json.hpp>

namespace splice::bench {

struct QualityOptions {
    std::string device = "auto";
    std::uint32_t width = 512, height = 512;
    std::size_t directions = 1;  // 1: the default view; more: that many of the 26, evenly picked
    int frames = 9;              // timed frames a view, after one that is not timed
    bool orthographic = false;
    double epsilon_scale = 1;
    Sides sides = Sides::kAsBaked;
    bool prefilter = true;
    std::uint32_t antialias = 1;  // samples along each side of a pixel
    BakeOptions bake;
    std::filesystem::path pictures;  // empty: none are written
};

/// PSNR of the hybrid and of all original triangles, drawn by the engine with one sample a pixel, against the oracle's
/// 64 samples; times. Prints tables; returns the figures.
nlohmann::json bench_capture(const std::vector<BenchModel>& models, const QualityOptions& options);

/// Holes, lost features and growth of the hybrid (see check_surface). Prints a table; `clean` of the result says
/// whether none was found.
nlohmann::json bench_holes(const std::vector<BenchModel>& models, const QualityOptions& options);

}  // namespace splice::bench
