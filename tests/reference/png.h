// Pictures of what a check saw, for people.
#pragma once

#include "tests/reference/images.h"

#include <filesystem>

namespace splice::reference {

/// Throws std::runtime_error.
void write_png(const std::filesystem::path& path, const ColourImage& image);

/// Brightness = |image - reference| times `gain`, per channel.
ColourImage difference(const ColourImage& image, const ColourImage& reference, int gain = 4);

}  // namespace splice::reference
