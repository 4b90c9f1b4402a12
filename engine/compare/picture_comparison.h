// Two pictures side by side, and a judgement where limits are given.
#pragma once

#include "engine/capture/png_file.h"
#include "engine/metrics/image_metrics.h"

#include <glm/glm.hpp>

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace splice {

struct ComparisonOptions {
    double erosion = 4;  // pixels by which "inside" stays away from the reference's border
    /// sRGB-encoded, 0..1. Pictures with alpha are laid over it (white without it); in pictures without alpha, pixels
    /// of exactly this colour show no object.
    std::optional<glm::dvec3> background;
};

/// Whatever is given must hold.
struct ComparisonLimits {
    std::optional<double> min_psnr, min_inside_psnr;  // dB
    std::optional<double> min_iou;
    std::optional<int> max_difference;           // levels of 8 bits
    std::optional<std::uint64_t> max_differing;  // pixels
};

struct PictureComparison {
    std::uint32_t width = 0, height = 0;
    double psnr_db = 0;  // infinite for equal pictures
    metrics::PixelDifferences found;
    std::optional<double> inside_db;  // where the object is known and somewhere thicker than the erosion
    std::uint64_t inside_pixels = 0;
    std::optional<double> iou;           // where both objects are known
    metrics::ColourImage first, second;  // as compared
};

/// `second` is the reference. What is object: the set pixels of `mask` (alpha and luminance at least a half); else
/// where alpha is at least a half; else what is not of the background's colour. Throws InputError when sizes differ;
/// `names` are for its message.
PictureComparison compare_pictures(const Picture& first, const Picture& second, const Picture* mask,
                                   const ComparisonOptions& options, const std::vector<std::string>& names);

/// One line for each limit that does not hold.
std::vector<std::string> broken_limits(const PictureComparison& comparison, const ComparisonLimits& limits);

}  // namespace splice
