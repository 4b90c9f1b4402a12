// Shaders that change while the window shows pictures, with the validation layers.
#include "engine/capture/png_file.h"
#include "tests/viewer/running_viewer.h"

#include <catch2/catch.hpp>

#include <filesystem>
#include <string>

using namespace splice;
using namespace splice::test;

namespace {

std::string replaced(std::string text, const std::string& from, const std::string& to) {
    const std::size_t at = text.find(from);
    REQUIRE(at != std::string::npos);
    return text.replace(at, from.size(), to);
}

std::size_t count_of(const std::string& text, const std::string& part) {
    std::size_t count = 0;
    for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1))
        ++count;
    return count;
}

// What every shader that writes the picture includes; its colours turn to their opposites.
constexpr const char* kFinish = "include/compose.glsl";
std::string negative(const std::string& source) {
    return replaced(source, "encode_srgb(light), 1)", "1 - encode_srgb(light), 1)");
}

void copy_shaders(const std::filesystem::path& folder) {
    std::filesystem::copy(source_file("shaders/glsl"), folder, std::filesystem::copy_options::recursive);
}

Picture model_part(const Picture& window) {
    return cropped(window, 240, 0, 500, 500);
}

}  // namespace

TEST_CASE("a changed source changes the picture, a mistake leaves the last good one, its end brings the first back") {
    const Stage stage(40);
    if (!stage.display) return;
    const auto& [display, folder] = stage;
    copy_shaders(folder / "glsl");
    RunningViewer viewer(folder.path(), display->name(),
                         {"knot.ply", "--device", "cpu", "--validate", "--size", "800x600", "--shaders", "glsl"});
    stage.wait_for("knot.ply");
    const auto compiled = [&](std::size_t times) {
        display->picture_when([&](const Picture&) { return count_of(viewer.out(), "compiled anew") >= times; });
        display->key("Escape");
        return display->still_picture();
    };
    const Picture first = compiled(1);
    const std::string source = read_text(folder / "glsl" / kFinish);
    write_text(folder / "glsl" / kFinish, negative(source));
    const Picture changed = compiled(2);
    CHECK(difference(model_part(first), model_part(changed)) > 0.05);

    const std::string other = read_text(folder / "glsl" / "surfel_normalise.frag");
    const std::size_t end = other.rfind('}');
    REQUIRE(end != std::string::npos);
    write_text(folder / "glsl" / "surfel_normalise.frag", other.substr(0, end) + "\nnot a statement\n}\n");
    display->picture_when([&](const Picture&) { return !viewer.err().empty(); });
    CHECK_THAT(viewer.err(), Catch::Contains("surfel_normalise.frag"));
    display->key("Escape");
    CHECK(difference(model_part(display->still_picture()), model_part(changed)) == 0);
    // Drawn anew, not only kept.
    display->key("1");
    CHECK(difference(model_part(display->still_picture()), model_part(changed)) > 0.02);
    display->key("f");

    write_text(folder / "glsl" / "surfel_normalise.frag", other);
    write_text(folder / "glsl" / kFinish, source);
    compiled(3);
    display->key("1");
    display->key("f");
    const Picture again = display->still_picture();
    display->key("p");
    display->picture_when([&](const Picture&) { return std::filesystem::exists(folder / "splice-view.png"); });
    CHECK(difference(model_part(again), model_part(changed)) > 0.05);
    // As the shaders within the program make it.
    display->key("c");
    display->picture_when([&](const Picture&) { return viewer.out().find("clipboard") != std::string::npos; });
    const auto line = display->clipboard();
    REQUIRE(line);
    CHECK(difference(captured_by(folder.path(), *line), read_png(folder / "splice-view.png")) == 0);
    display->ask_to_close();
    CHECK(viewer.wait() == 0);
}

TEST_CASE("watched shaders survive a lost device, and so do the last good ones beside a mistake") {
    const Stage stage(40);
    if (!stage.display) return;
    const auto& [display, folder] = stage;
    copy_shaders(folder / "glsl");
    const std::string script =
        "wait\nframes 3\nwait\nscreenshot before.png\nlose-device\nwait\nframes 3\nwait\nscreenshot after.png\nquit\n";
    REQUIRE(stage.run_script(script, "700x500").code == 0);
    const Picture plain = read_png(folder / "before.png");
    write_text(folder / "glsl" / kFinish, negative(read_text(folder / "glsl" / kFinish)));
    write_text(folder / "script.txt", script);
    RunningViewer viewer(folder.path(), display->name(),
                         {"knot.ply", "--device", "cpu", "--validate", "--size", "700x500", "--shaders", "glsl",
                          "--script", "script.txt"});
    CHECK(viewer.wait() == 0);
    const Picture before = read_png(folder / "before.png"), after = read_png(folder / "after.png");
    CHECK(difference(before, plain) > 0.05);
    CHECK(difference(before, after) == 0);
}
