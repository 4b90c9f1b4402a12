// splice-capture's options.
#pragma once

#include "engine/capture/capture.h"
#include "engine/scene/scene_file.h"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace splice {

/// What the command line says; what it leaves open is the scene's or the default.
struct CaptureCommand {
    bool list_devices = false;
    std::vector<std::filesystem::path> inputs;
    std::filesystem::path output;
    RendererOptions renderer;
    std::optional<std::pair<std::uint32_t, std::uint32_t>> size;  // pixels
    std::optional<glm::dvec3> eye, target, up;                    // world units
    std::optional<double> fov_degrees, azimuth_degrees, elevation_degrees, zoom;
    bool orthographic = false;
    std::optional<double> orthographic_height;  // world units
    std::uint32_t orbit = 0;                    // frames, 0: a single picture
    std::optional<View> view;
    std::optional<Backend> backend;
    std::optional<double> points_below;  // pixels
    std::optional<Shown> shown;
    std::optional<Background> background;
    std::optional<Sides> sides;
    std::optional<double> epsilon_scale;
    std::optional<bool> prefilter;
    std::optional<Shading> shading;
    std::optional<double> merge_px;   // pixels
    std::optional<double> tau;        // pixels
    std::optional<double> budget_ms;  // of a frame
    bool calibrate = false;
    std::optional<std::uint64_t> memory;  // bytes of surfels
    std::optional<Kernel> kernel;
    std::optional<std::uint32_t> antialias;  // samples along a pixel's side
    std::optional<std::filesystem::path> stats;
    std::optional<std::filesystem::path> graph;  // ends in .dot, .mmd or .json
    bool quiet = false;
};

/// Nothing when --help or --version was asked for and printed. Throws UsageError.
std::optional<CaptureCommand> parse_capture_command(int argc, const char* const* argv);

}  // namespace splice
