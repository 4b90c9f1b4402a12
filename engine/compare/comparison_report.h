// What splice-compare prints.
#pragma once

#include "engine/compare/picture_comparison.h"

#include <string>

namespace splice {

std::string comparison_text(const PictureComparison& comparison);

/// {width, height, identical, psnr_db, largest_difference: {levels, x, y}, differing_pixels, inside_db, inside_pixels,
/// iou, broken: [...]}. null: what is not known, and the dB of equal pixels, which are infinite.
std::string comparison_json(const PictureComparison& comparison, const std::vector<std::string>& broken);

}  // namespace splice
