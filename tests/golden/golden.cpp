#include "tests/golden/golden.h"

#include "tests/support/test_files.h"

#include <algorithm>
#include <cstdlib>

namespace splice::test {

std::string compare_with_golden(const std::string& name, const Picture& picture, const GoldenTolerance& tolerance) {
    const std::filesystem::path committed = source_file("tests/golden/" + name + ".png");
    if (std::getenv("SPLICE_UPDATE_GOLDEN")) {
        write_png(committed, picture);
        return "";
    }
    const auto leave = [&](const std::string& what, const Picture& shown) {
        const std::filesystem::path path = artefact("golden-" + name + what + ".png");
        write_png(path, shown);
        return path.string();
    };
    if (!std::filesystem::exists(committed))
        return "there is no " + committed.string() + " to compare " + leave("", picture) + " with";
    const Picture golden = read_png(committed);
    if (golden.width != picture.width || golden.height != picture.height)
        return leave("", picture) + " has another size than " + committed.string();

    Picture difference = picture;
    std::size_t bad = 0;
    for (std::size_t i = 0; i < picture.rgba.size(); i += 4) {
        int worst = 0;
        for (std::size_t channel = 0; channel < 4; ++channel) {
            const int distance = std::abs(picture.rgba[i + channel] - golden.rgba[i + channel]);
            worst = std::max(worst, distance);
            difference.rgba[i + channel] = channel < 3 ? static_cast<std::uint8_t>(std::min(8 * distance, 255)) : 255;
        }
        bad += worst > tolerance.channel ? 1 : 0;
    }
    const double pixels = static_cast<double>(picture.rgba.size()) / 4;
    if (static_cast<double>(bad) <= tolerance.bad_pixels * pixels) return "";
    return std::to_string(bad) + " pixels differ by more than " + std::to_string(tolerance.channel) + " levels from " +
           committed.string() + "; see " + leave("", picture) + " and, eight times amplified, " +
           leave("-difference", difference);
}

}  // namespace splice::test
