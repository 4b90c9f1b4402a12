#include "engine/viewer/capture_line.h"

#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>

namespace splice {

namespace {

// The shortest text that reads back as the same number.
std::string exact(double value) {
    std::array<char, 32> text{};
    const auto [end, error] = std::to_chars(text.data(), text.data() + text.size(), value);
    return {text.data(), end};
}

std::string exact(const glm::dvec3& v) {
    return exact(v.x) + "," + exact(v.y) + "," + exact(v.z);
}

std::string quoted(const std::string& word) {
    std::string text = "'";
    for (const char c : word)
        text += c == '\'' ? std::string("'\\''") : std::string(1, c);
    return text + "'";
}

std::string hex(const glm::dvec3& colour) {
    const auto channel = [](double value) { return static_cast<unsigned>(std::lround(value * 255)) & 255U; };
    std::array<char, 8> text{};
    std::snprintf(text.data(), text.size(), "#%02x%02x%02x", channel(colour.r), channel(colour.g), channel(colour.b));
    return text.data();
}

}  // namespace

std::string capture_line(const std::vector<std::filesystem::path>& inputs, const CaptureSettings& settings,
                         const Background& background) {
    const Camera& camera = settings.camera;
    std::string line = "splice-capture";
    for (const std::filesystem::path& input : inputs)
        line += " " + quoted(input.string());
    line += " -o capture.png --size " + std::to_string(settings.width) + "x" + std::to_string(settings.height);
    line += " --eye=" + exact(camera.eye) + " --target=" + exact(camera.target) + " --up=" + exact(camera.up);
    if (camera.orthographic) {
        line += " --orthographic --height " + exact(camera.orthographic_height);
    } else {
        line += " --fov " + exact(camera.fov_y_degrees);
    }
    line += " --view " + std::string(name_of(settings.view));
    line += " --backend " + std::string(name_of(settings.backend));
    line += " --shading " + std::string(name_of(settings.shading));
    line += " --antialias " + std::to_string(settings.antialias);
    line += " --merge " + exact(settings.merge_px);
    line += " --tau " + exact(settings.tau);
    line += " --kernel " + text_of(settings.kernel);
    line += " --show " + std::string(name_of(settings.shown));
    line += " --background " + quoted(background.transparent ? "transparent" : hex(background.colour));
    if (settings.sides == Sides::kOneSided) line += " --one-sided";
    if (settings.sides == Sides::kTwoSided) line += " --two-sided";
    line += " --epsilon-scale " + exact(settings.epsilon_scale);
    line += std::string(" --prefilter ") + (settings.prefilter ? "on" : "off");
    return line;
}

}  // namespace splice
