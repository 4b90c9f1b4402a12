// `splice-bench quality`: one picture of each scene against the oracle's, which casts 64 rays a pixel.
#pragma once

#include "engine/capture/capture.h"

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace splice::bench {

struct QualityCommand {
    std::vector<std::string> subjects;  // meshes, scenes, "bumpy-sphere" and perhaps a number after it
    std::filesystem::path folder;       // of the thesis's models, when there are no subjects
    double distance = 2.5;              // of the eye from the bumpy sphere's centre
    double depth = 2.418;               // of the bumpy sphere's disks: how many lie over a point
    std::string device = "auto", size = "512x512", backend = "sprite";
    std::vector<std::string> shading = {"surfel"};
    std::vector<std::uint32_t> antialias = {1};  // samples along each side of a pixel, each in turn
    std::vector<double> merge = {kMergePixels};  // CaptureSettings::merge_px, each in turn
    std::filesystem::path json, pictures;
};

/// Adds the command and its options to the program's; `command` must outlive the parsing.
CLI::App& add_quality_command(CLI::App& program, QualityCommand& command);

/// Measures, prints a table, writes the files. Throws UsageError, InputError, SystemError, DeviceError.
void run_quality_command(const QualityCommand& command);

}  // namespace splice::bench
