#include "engine/compare/picture_comparison.h"

#include "preprocess/model_format/error.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace splice {

namespace {

using metrics::ColourImage;
using metrics::Mask;
using metrics::Rgb8;

double linear_of(double c) {
    return c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
}

std::uint8_t encoded(double linear) {
    const double c = std::clamp(linear, 0.0, 1.0);
    return static_cast<std::uint8_t>(
        std::lround(255 * (c <= 0.0031308 ? 12.92 * c : 1.055 * std::pow(c, 1 / 2.4) - 0.055)));
}

bool has_alpha(const Picture& picture) {
    for (std::size_t i = 3; i < picture.rgba.size(); i += 4)
        if (picture.rgba[i] != 255) return true;
    return false;
}

/// Laid over the background in linear light.
ColourImage over(const Picture& picture, const glm::dvec3& background) {
    ColourImage image(picture.width, picture.height);
    for (std::size_t i = 0; i < image.pixels.size(); ++i) {
        const std::uint8_t* rgba = &picture.rgba[4 * i];
        Rgb8& pixel = image.pixels[i];
        pixel = {rgba[0], rgba[1], rgba[2]};
        if (rgba[3] == 255) continue;
        const double alpha = rgba[3] / 255.0;
        std::uint8_t* const channels[3] = {&pixel.r, &pixel.g, &pixel.b};
        for (int c = 0; c < 3; ++c)
            *channels[c] = encoded(alpha * linear_of(rgba[c] / 255.0) + (1 - alpha) * linear_of(background[c]));
    }
    return image;
}

Mask where(const Picture& picture, const auto& rule) {
    Mask mask(picture.width, picture.height);
    for (std::size_t i = 0; i < mask.pixels.size(); ++i)
        mask.pixels[i] = rule(&picture.rgba[4 * i]) ? 1 : 0;
    return mask;
}

std::optional<Mask> object_of(const Picture& picture, const std::optional<glm::dvec3>& background) {
    if (has_alpha(picture)) return where(picture, [](const std::uint8_t* rgba) { return rgba[3] >= 128; });
    if (!background) return std::nullopt;
    const auto level = [&](int c) { return static_cast<int>(std::lround(255 * (*background)[c])); };
    return where(picture, [&](const std::uint8_t* rgba) {
        return rgba[0] != level(0) || rgba[1] != level(1) || rgba[2] != level(2);
    });
}

void require_size(const Picture& picture, const Picture& other, const std::string& name,
                  const std::string& other_name) {
    if (picture.width == other.width && picture.height == other.height) return;
    throw InputError(name, "",
                     fmt::format("{}x{} pixels, but {} has {}x{}", picture.width, picture.height, other_name,
                                 other.width, other.height));
}

}  // namespace

PictureComparison compare_pictures(const Picture& first, const Picture& second, const Picture* mask,
                                   const ComparisonOptions& options, const std::vector<std::string>& names) {
    require_size(second, first, names.at(1), names.at(0));
    if (mask) require_size(*mask, first, names.at(2), names.at(0));
    const glm::dvec3 background = options.background.value_or(glm::dvec3(1));
    PictureComparison result;
    result.width = first.width;
    result.height = first.height;
    result.first = over(first, background);
    result.second = over(second, background);
    result.psnr_db = metrics::psnr(result.first, result.second);
    result.found = metrics::count_differences(result.first, result.second);

    std::optional<Mask> object, of_first;
    if (mask) {
        object = where(*mask, [](const std::uint8_t* rgba) {
            return rgba[3] >= 128 && 2126 * rgba[0] + 7152 * rgba[1] + 722 * rgba[2] >= 10000 * 128;
        });
    } else {
        of_first = object_of(first, options.background);
        object = object_of(second, options.background);
        if (of_first && object) result.iou = metrics::silhouette_iou(*of_first, *object);
    }
    if (!object) return result;
    const Mask inside = metrics::eroded(*object, options.erosion);
    result.inside_pixels = static_cast<std::uint64_t>(std::count(inside.pixels.begin(), inside.pixels.end(), 1));
    if (result.inside_pixels > 0) result.inside_db = metrics::psnr(result.first, result.second, &inside);
    return result;
}

std::vector<std::string> broken_limits(const PictureComparison& comparison, const ComparisonLimits& limits) {
    std::vector<std::string> broken;
    const auto at_least = [&](const char* name, const std::optional<double>& found,
                              const std::optional<double>& limit) {
        if (!limit || (found && *found >= *limit)) return;
        broken.push_back(found ? fmt::format("{} is {:.6g}, less than {:.6g}", name, *found, *limit)
                               : fmt::format("{} is not known: nothing says where the object is", name));
    };
    at_least("PSNR", comparison.psnr_db, limits.min_psnr);
    at_least("PSNR inside", comparison.inside_db, limits.min_inside_psnr);
    at_least("silhouette IoU", comparison.iou, limits.min_iou);
    if (limits.max_difference && comparison.found.largest > *limits.max_difference)
        broken.push_back(fmt::format("the largest difference is {}, more than {}", comparison.found.largest,
                                     *limits.max_difference));
    if (limits.max_differing && comparison.found.pixels > *limits.max_differing)
        broken.push_back(fmt::format("{} pixels differ, more than {}", comparison.found.pixels, *limits.max_differing));
    return broken;
}

}  // namespace splice
