// The command line of splice-capture that makes the picture that a window shows.
#pragma once

#include "engine/capture/capture.h"

#include <filesystem>
#include <string>
#include <vector>

namespace splice {

/// One line, quoted for a shell: the same pixels, if the files say the rest (lights, how meshes are baked).
std::string capture_line(const std::vector<std::filesystem::path>& inputs, const CaptureSettings& settings,
                         const Background& background);

}  // namespace splice
