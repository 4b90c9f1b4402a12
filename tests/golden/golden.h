// Pictures compared with committed ones.
#pragma once

#include "engine/capture/png_file.h"

#include <string>

namespace splice::test {

struct GoldenTolerance {
    int channel = 6;            // 8-bit levels that a channel may differ by; more makes a pixel bad
    double bad_pixels = 0.002;  // share of the picture's pixels that may be bad
};

/// Compares with tests/golden/NAME.png. Otherwise says why not; the picture, and a picture of the differences, are then
/// left among the test artefacts as golden-NAME.png and golden-NAME-difference.png. With SPLICE_UPDATE_GOLDEN set,
/// writes the committed picture instead and reports nothing.
std::string compare_with_golden(const std::string& name, const Picture& picture, const GoldenTolerance& tolerance = {});

}  // namespace splice::test
