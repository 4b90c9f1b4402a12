// What the window shows beside one picture: comparisons, the render graph, what was picked, flights.
#include "engine/capture/png_file.h"
#include "preprocess/mesh/shapes.h"
#include "preprocess/mesh/write_mesh.h"
#include "tests/viewer/running_viewer.h"

#include <catch2/catch.hpp>
#include <glm/glm.hpp>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <sstream>
#include <string>

using namespace splice;
using namespace splice::test;

namespace {

constexpr std::uint32_t kLine = 3;       // pixels beside the line that it may cover
constexpr std::uint32_t kCaptions = 40;  // at the bottom of the pictures

std::size_t pixels_of(const Picture& picture, const std::array<int, 3>& colour) {
    std::size_t count = 0;
    for (std::size_t i = 0; i < picture.rgba.size(); i += 4) {
        bool same = true;
        for (std::size_t c = 0; c < 3; ++c)
            same = same && std::abs(int{picture.rgba[i + c]} - colour[c]) <= 2;
        count += same ? 1 : 0;
    }
    return count;
}

std::size_t covered(const Picture& picture) {
    return picture.rgba.size() / 4 - pixels_of(picture, {255, 255, 255});
}

}  // namespace

TEST_CASE("a wipe shows the left look left of the line and the right one right of it, each where it belongs") {
    const Stage stage;
    if (!stage.display) return;
    const auto [code, err] = stage.run_script(
        "wait\nset view normals\nset show hybrid\ncompare wipe\nset wipe 0.45\nset edited right\n"
        "set show triangles\nset view depth\nwait\nscreenshot right.png\nset edited left\nscreenshot left.png\n"
        "key escape\nwait\nscreenshot-window wiped.png\n"
        "drag left 615 200 825 200\nwait\nscreenshot-window dragged.png\nquit\n");
    CHECK(code == 0);
    CHECK(err == "");
    const Picture left = read_png(stage.folder / "left.png"), right = read_png(stage.folder / "right.png");
    REQUIRE(difference(left, right) > 0.1);
    for (const auto& [name, share] : {std::pair{"wiped.png", 0.45}, {"dragged.png", 0.75}}) {
        INFO(name);
        const Picture shown = scene_part(read_png(stage.folder / name));
        const std::uint32_t height = shown.height - kCaptions;
        const auto line = static_cast<std::uint32_t>(share * shown.width);
        CHECK(difference(cropped(shown, 0, 0, line - kLine, height), cropped(left, 0, 0, line - kLine, height)) == 0);
        const std::uint32_t from = line + kLine, rest = shown.width - from;
        CHECK(difference(cropped(shown, from, 0, rest, height), cropped(right, from, 0, rest, height)) == 0);
    }
}

TEST_CASE("side by side, each half has the whole model, by its own look") {
    const Stage stage;
    if (!stage.display) return;
    const auto [code, err] = stage.run_script(
        "wait\ncompare side-by-side\nset view normals\nset edited right\nset show triangles\nset view depth\nkey f\n"
        "wait\nscreenshot right.png\nset edited left\nscreenshot left.png\nkey escape\nwait\n"
        "screenshot-window both.png\nquit\n");
    CHECK(code == 0);
    CHECK(err == "");
    const Picture shown = scene_part(read_png(stage.folder / "both.png"));
    const Picture left = read_png(stage.folder / "left.png"), right = read_png(stage.folder / "right.png");
    REQUIRE(left.width + right.width == shown.width);
    REQUIRE(left.width == shown.width / 2);
    const std::uint32_t height = shown.height - kCaptions, width = left.width - kLine;
    CHECK(difference(cropped(shown, 0, 0, width, height), cropped(left, 0, 0, width, height)) == 0);
    CHECK(difference(cropped(shown, left.width + kLine, 0, right.width - kLine, height),
                     cropped(right, kLine, 0, right.width - kLine, height)) == 0);
    CHECK(difference(left, right) > 0.1);
}

TEST_CASE("G opens the render graph, and the pass under the cursor is lit there and in the plot") {
    const Stage stage;
    if (!stage.display) return;
    write_model_file(stage.folder / "knot.ply", stage.folder / "knot.splice");
    // The first box: beyond frame, title and gaps of the graph's window, which stands at the bottom. Lists of the view
    // are folded, so that the plot is in sight.
    const auto [code, err] = stage.run_script(
        "wait\nclick left 150 18\nframes 4\nwait\nscreenshot-window without.png\nkey g\nmove 700 100\nwait\n"
        "frames 4\nscreenshot-window dark.png\nmove 345 618\nframes 4\nwait\nscreenshot-window lit.png\nkey g\n"
        "frames 4\nwait\nscreenshot-window closed.png\nquit\n",
        "1000x800", {"knot.splice"});
    CHECK(code == 0);
    CHECK(err == "");
    constexpr std::array kLit{190, 130, 40}, kBox{52, 60, 72};
    const auto shown = [&](const char* name) { return cropped(read_png(stage.folder / name), kPanel, 560, 690, 200); };
    CHECK(pixels_of(shown("without.png"), kBox) < 50);
    CHECK(pixels_of(shown("dark.png"), kBox) > 1000);
    CHECK(pixels_of(shown("dark.png"), kLit) == 0);
    CHECK(pixels_of(shown("lit.png"), kLit) > 300);
    CHECK(pixels_of(shown("closed.png"), kBox) < 50);
    // In the plot all other passes are dimmed: their names lose half of their colour.
    const auto colourfulness = [&](const char* name) {
        const Picture panel = cropped(read_png(stage.folder / name), 0, 30, kPanel - 20, 740);
        std::int64_t sum = 0;
        for (std::size_t i = 0; i < panel.rgba.size(); i += 4) {
            const auto [least, most] = std::minmax({panel.rgba[i], panel.rgba[i + 1], panel.rgba[i + 2]});
            sum += most - least;
        }
        return sum;
    };
    CHECK(colourfulness("lit.png") + 10000 < colourfulness("dark.png"));
}

TEST_CASE("a click picks the triangle or the surfel that is seen there") {
    const Stage stage;
    if (!stage.display) return;
    write_ply(shapes::ico_sphere(16), stage.folder / "ball.ply");
    const auto [code, err] = stage.run_script(
        "wait\nset bake triangles\nrebake\nwait\nclick left 650 287\nframes 2\nstatistics triangles.json\n"
        "camera-line line.txt\n"
        "set bake surfels\nrebake\nwait\nstatistics none.json\nclick left 650 287\nframes 2\nstatistics surfels.json\n"
        "click left 320 20\nframes 2\nstatistics beside.json\nquit\n",
        "1000x600", {"ball.ply"});
    CHECK(code == 0);
    CHECK(err == "");
    const auto picked = [&](const char* name) {
        return nlohmann::json::parse(read_text(stage.folder / name)).at("picked");
    };
    const std::string line = read_text(stage.folder / "line.txt");
    const auto vector_of = [&](const std::string& option) {
        std::istringstream text(line.substr(line.find(option) + option.size()));
        glm::dvec3 v;
        char comma = 0;
        text >> v.x >> comma >> v.y >> comma >> v.z;
        return v;
    };
    CHECK(picked("none.json").is_null());
    CHECK(picked("beside.json").is_null());
    for (const char* kind : {"triangles", "surfels"}) {
        INFO(kind);
        const auto hit = picked((std::string(kind) + ".json").c_str());
        REQUIRE(hit.is_object());
        CHECK(hit.at("kind") == kind);
        // On the unit sphere, between the eye and what the picture's middle looks at.
        const auto& at = hit.at("point");
        const glm::dvec3 point(at.at(0), at.at(1), at.at(2));
        CHECK(glm::length(point) == Approx(1).margin(0.02));
        const glm::dvec3 eye = vector_of("--eye="), target = vector_of("--target=");
        CHECK(glm::dot(point - eye, target - eye) > 0);
        CHECK(glm::length(glm::cross(point - eye, glm::normalize(target - eye))) < 0.01);
        CHECK(glm::length(point - eye) < glm::length(eye));
    }
}

TEST_CASE("with the right button and W held it flies towards what it looks at, with S away") {
    const Stage stage;
    if (!stage.display) return;
    const auto [code, err] = stage.run_script(
        "wait\nscreenshot start.png\nmove 650 287\npress right\nhold w\nframes 8\nlet-go w\nrelease right\nwait\n"
        "screenshot nearer.png\npress right\nhold s\nframes 24\nlet-go s\nrelease right\nwait\n"
        "screenshot farther.png\nhold w\nframes 8\nlet-go w\nwait\nscreenshot still.png\nquit\n");
    CHECK(code == 0);
    CHECK(err == "");
    const auto size = [&](const char* name) { return covered(read_png(stage.folder / name)); };
    CHECK(size("nearer.png") > size("start.png"));
    CHECK(size("farther.png") < size("nearer.png"));
    CHECK(difference(read_png(stage.folder / "still.png"), read_png(stage.folder / "farther.png")) == 0);
}

TEST_CASE("images reach the screen in the mode that was asked for") {
    const Stage stage(40);
    if (!stage.display) return;
    write_text(stage.folder / "script.txt", "wait\nstatistics mode.json\nquit\n");
    for (const std::string mode : {"fifo", "relaxed", "mailbox", "immediate"}) {
        INFO(mode);
        RunningViewer viewer(stage.folder.path(), stage.display->name(),
                             {"knot.ply", "--device", "cpu", "--validate", "--size", "600x400", "--present-mode", mode,
                              "--script", "script.txt"});
        CHECK(viewer.wait() == 0);
        CHECK(viewer.err() == "");
        const auto got = nlohmann::json::parse(read_text(stage.folder / "mode.json")).at("present_mode");
        // Displays may lack a mode, then it is fifo; Mesa's software device has these.
        if (mode == "fifo" || mode == "immediate" || mode == "mailbox") CHECK(got == mode);
    }
}
