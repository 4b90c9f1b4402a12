#include "engine/compare/comparison_report.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <cmath>

namespace splice {

namespace {

std::string decibels(double db) {
    return std::isinf(db) ? "infinite" : fmt::format("{:.2f} dB", db);
}

nlohmann::json number(const std::optional<double>& value) {
    return value && std::isfinite(*value) ? nlohmann::json(*value) : nlohmann::json(nullptr);
}

}  // namespace

std::string comparison_text(const PictureComparison& comparison) {
    const metrics::PixelDifferences& found = comparison.found;
    std::string text = fmt::format("size                {}x{}\n", comparison.width, comparison.height);
    text += fmt::format("PSNR                {}\n", decibels(comparison.psnr_db));
    if (comparison.inside_db)
        text += fmt::format("PSNR inside         {} over {} pixels\n", decibels(*comparison.inside_db),
                            comparison.inside_pixels);
    if (comparison.iou) text += fmt::format("silhouette IoU      {:.5f}\n", *comparison.iou);
    text += fmt::format("differing pixels    {}\n", found.pixels);
    text += found.largest == 0 ? std::string("largest difference  0\n")
                               : fmt::format("largest difference  {} at ({}, {})\n", found.largest, found.x, found.y);
    return text;
}

std::string comparison_json(const PictureComparison& comparison, const std::vector<std::string>& broken) {
    const metrics::PixelDifferences& found = comparison.found;
    const nlohmann::ordered_json json = {
        {"width", comparison.width},
        {"height", comparison.height},
        {"identical", found.pixels == 0},
        {"psnr_db", number(comparison.psnr_db)},
        {"largest_difference", {{"levels", found.largest}, {"x", found.x}, {"y", found.y}}},
        {"differing_pixels", found.pixels},
        {"inside_db", number(comparison.inside_db)},
        {"inside_pixels", comparison.inside_pixels},
        {"iou", number(comparison.iou)},
        {"broken", broken}};
    return json.dump(2) + "\n";
}

}  // namespace splice
