// Everything that `splice-bench frame` finds out, as plain data, and how it is shown.
#pragma once

#include "engine/bench/report/sample.h"

#include <nlohmann/json.hpp>

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace splice::bench {

struct PassSample {
    std::string name;
    Sample gpu_ms;
};

/// One variant of one scene: frames of it took turns with those of the scene's other variants.
struct FrameRow {
    std::string scene, backend, shading;       // backend "bare": plain Vulkan, see bare_sprites.h
    std::uint32_t width = 0, height = 0;       // pixels
    std::uint64_t surfels = 0, triangles = 0;  // sent to the device
    std::uint64_t covered_pixels = 0;
    std::uint64_t fragments = 0;     // useful ones: what surfels contribute to pixels, all together
    Sample frame_ms;                 // submission to completion, read back included
    Sample cpu_ms;                   // of all threads: what a busy machine distorts least
    std::vector<PassSample> passes;  // in order of execution
    std::vector<std::pair<std::string, std::uint64_t>> drawn_by;  // backend, surfels

    double coverage() const {
        return static_cast<double>(covered_pixels) / (static_cast<double>(width) * static_cast<double>(height));
    }
    /// Of a count a frame, by the median.
    double per_second(std::uint64_t count) const {
        return frame_ms.median > 0 ? static_cast<double>(count) / frame_ms.median * 1e3 : 0;
    }
};

/// What a ratio of two rows should be.
struct FrameGoal {
    std::string meaning;
    double reached = 0, goal = 0;
    bool at_most = false;
    bool met() const { return at_most ? reached <= goal : reached >= goal; }
};

struct FrameReport {
    std::string device;
    unsigned rounds = 0;
    std::vector<FrameRow> rows;
};

/// Of the frames without arguments; empty where the rows are others.
std::vector<FrameGoal> goals_of(const FrameReport& report);

inline constexpr const char* kFrameReportKind = "splice-bench frame";
inline constexpr int kFrameReportVersion = 1;

std::string frame_report_text(const FrameReport& report);
nlohmann::json frame_report_json(const FrameReport& report);
std::string frame_report_html(const FrameReport& report);
/// What moved since `before`, a report of frame_report_json(); see change_report().
std::string compare_frame_reports(const nlohmann::json& before, const nlohmann::json& now, const std::string& old_name);

}  // namespace splice::bench
