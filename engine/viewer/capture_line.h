// The command line of splice-capture that makes the picture that a window shows.
#pragma once

#include "engine/capture/capture.h"

#include <filesystem>
#include <string>

namespace splice {

/// One line, quoted for a shell; the same pixels, provided that the scene's file says the same lights.
std::string capture_line(const std::filesystem::path& input, const CaptureSettings& settings,
                         const Background& background);

}  // namespace splice
