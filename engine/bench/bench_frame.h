// Frame times of the splat backends, interleaved in one process so that a busy machine hits all alike.
#pragma once

#include <nlohmann/json.hpp>

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace splice::bench {

struct FrameBenchOptions {
    std::string device = "auto";
    std::uint32_t width = 512, height = 512;  // pixels
    unsigned rounds = 15;                     // timed frames a backend and scene
};

/// `models`: model files or meshes; without any, the bumpy sphere of 50,000, 300,000 and 1,000,000 disks, ten deep.
/// Prints a table and returns the figures.
nlohmann::json bench_frame(const std::vector<std::filesystem::path>& models, const FrameBenchOptions& options);

}  // namespace splice::bench
