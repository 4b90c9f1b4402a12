// What happens to a window, and to the device and the surface behind it: in a real window, with the validation layers.
#include "engine/capture/png_file.h"
#include "tests/cli/spawn.h"
#include "tests/viewer/running_viewer.h"
#include "tests/viewer/virtual_display.h"

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include <filesystem>
#include <string>
#include <utility>

using namespace splice;
using namespace splice::test;

TEST_CASE("a lost device is opened again once, the second loss ends the run") {
    const Stage stage;
    if (!stage.display) return;
    const auto [code, err] = stage.run_script("wait\nscreenshot a.png\nlose-device\nwait\nscreenshot b.png\nquit\n");
    CHECK(code == 0);
    CHECK_THAT(err, Catch::Contains("The device was lost and opened again"));
    CHECK(difference(read_png(stage.folder / "a.png"), read_png(stage.folder / "b.png")) == 0);
    const auto [second_code, second_err] = stage.run_script("wait\nlose-device\nwait\nlose-device\nwait\nquit\n");
    CHECK(second_code == 1);
    CHECK_THAT(second_err, Catch::Contains("lost twice"));
}

TEST_CASE("a lost surface is made anew, each time") {
    const Stage stage;
    if (!stage.display) return;
    const auto [code, err] = stage.run_script(
        "wait\nscreenshot-window a.png\nlose-surface\nkey escape\nwait\nscreenshot-window b.png\n"
        "drag left 600 200 640 220\nlose-surface\nkey escape\nwait\nlose-surface\nwait\nscreenshot c.png\nquit\n");
    CHECK(code == 0);
    CHECK(line_count(err) == 3);
    CHECK_THAT(err, Catch::Contains("The window's surface was lost and made anew"));
    const Picture before = read_png(stage.folder / "a.png"), after = read_png(stage.folder / "b.png");
    CHECK(difference(scene_part(before), scene_part(after)) == 0);
    CHECK(difference(scene_part(before), read_png(stage.folder / "c.png")) > 0.03);
}

TEST_CASE("a surface that is lost before anything was shown on it ends the run") {
    const Stage stage(40);
    if (!stage.display) return;
    const auto [code, err] = stage.run_script("lose-surface\nwait\nquit\n");
    CHECK(code == 1);
    CHECK_THAT(err, Catch::Contains("before anything was shown"));
}

TEST_CASE("a window that another program destroys ends the run, at rest and in motion") {
    const Stage stage(40);
    if (!stage.display) return;
    const bool in_motion = GENERATE(false, true);
    RunningViewer viewer(stage.folder.path(), stage.display->name(),
                         {"knot.ply", "--device", "cpu", "--size", "1000x600"});
    stage.wait_for("knot.ply");
    stage.display->still_picture();
    if (in_motion) {
        stage.display->move(600, 300);
        stage.display->press(1);
        stage.display->move(640, 310);
    }
    stage.display->destroy_window();
    if (in_motion) stage.display->release(1);
    CHECK(viewer.wait(20) == 1);
    CHECK(viewer.err() == "splice-view: the window is gone: another program destroyed it\n");
}

TEST_CASE("on a monitor of another scale, panels and letters follow, and come back as they were") {
    const Stage stage;
    if (!stage.display) return;
    const auto [code, err] = stage.run_script(
        "wait\nscreenshot-window one-window.png\nscreenshot one.png\n"
        "monitor-scale 1.5\nkey escape\nwait\nscreenshot-window larger-window.png\nscreenshot larger.png\n"
        "monitor-scale 1\nkey escape\nwait\nscreenshot-window back-window.png\nscreenshot back.png\nquit\n");
    CHECK(code == 0);
    CHECK(err == "");
    // At 1.5 a window of 1000 is a narrow one, whose panel is 216 wide.
    const Picture one = read_png(stage.folder / "one.png"), larger = read_png(stage.folder / "larger.png");
    CHECK(one.width == 1000 - kPanel);
    CHECK(one.height == 600 - kStatus);
    CHECK(larger.width == 1000 - 324);
    CHECK(larger.height == 600 - 39);
    const Picture window = read_png(stage.folder / "larger-window.png");
    CHECK(difference(cropped(window, 324, 0, larger.width, larger.height), larger) == 0);
    CHECK(difference(read_png(stage.folder / "back.png"), one) == 0);
    // Times differ; the first lists of the panel do not.
    const auto lists = [&](const char* name) { return cropped(read_png(stage.folder / name), 0, 0, kPanel, 200); };
    CHECK(difference(lists("back-window.png"), lists("one-window.png")) == 0);
    CHECK(difference(lists("larger-window.png"), lists("one-window.png")) > 0.05);
}

TEST_CASE("on a scaled monitor a window has the size that it was left with, each time it is started") {
    const Stage stage(40);
    if (!stage.display) return;
    const auto& [display, folder] = stage;
    display->set_dots_per_inch(144);
    const auto start_and_close = [&](unsigned width, unsigned height) {
        RunningViewer viewer(folder.path(), display->name(), {"knot.ply", "--device", "cpu"});
        stage.wait_for("knot.ply");
        const Picture started = display->still_picture();
        if (width > 0) {
            display->resize(width, height);
            display->picture_when([&](const Picture& now) { return now.width == width; });
        }
        display->ask_to_close();
        CHECK(viewer.wait() == 0);
        CHECK(viewer.err() == "");
        return std::pair{started.width, started.height};
    };
    std::filesystem::create_directories(folder / "splice");
    write_text(folder / "splice" / "view.json", R"({"width": 600, "height": 400})");
    CHECK(start_and_close(0, 0) == std::pair{900U, 600U});
    CHECK(start_and_close(1050, 750) == std::pair{900U, 600U});
    CHECK(start_and_close(0, 0) == std::pair{1050U, 750U});
    CHECK(start_and_close(0, 0) == std::pair{1050U, 750U});
}

TEST_CASE("as small as a window gets, it waits and comes back") {
    const Stage stage(40);
    if (!stage.display) return;
    const auto [code, err] = stage.run_script(
        "wait\nscreenshot a.png\nresize 1 1\nframes 5\nresize 30 20\nframes 5\nresize 800 600\nframes 5\nwait\n"
        "screenshot b.png\nquit\n",
        "800x600");
    CHECK(code == 0);
    CHECK(err == "");
    CHECK(read_png(stage.folder / "a.png").width == read_png(stage.folder / "b.png").width);
}

TEST_CASE("minimised, it draws nothing, what was asked for meanwhile is there once it is back") {
    const Stage stage(40);
    if (!stage.display) return;
    RunningViewer viewer(stage.folder.path(), stage.display->name(),
                         {"knot.ply", "--device", "cpu", "--validate", "--size", "1000x600"});
    stage.wait_for("knot.ply");
    const Picture shown = stage.display->still_picture();
    stage.display->say_minimised(true);
    stage.display->key("v");
    CHECK(difference(stage.display->still_picture(), shown) == 0);
    stage.display->say_minimised(false);
    const Picture back = stage.display->picture_when(
        [&](const Picture& now) { return difference(scene_part(now), scene_part(shown)) > 0.01; });
    CHECK(difference(scene_part(back), scene_part(shown)) > 0.01);
    stage.display->ask_to_close();
    CHECK(viewer.wait() == 0);
    CHECK(viewer.err() == "");
}

TEST_CASE("sizes that change faster than frames are shown: the last one counts") {
    const Stage stage(40);
    if (!stage.display) return;
    RunningViewer viewer(stage.folder.path(), stage.display->name(),
                         {"knot.ply", "--device", "cpu", "--validate", "--size", "1000x600"});
    stage.wait_for("knot.ply");
    for (unsigned round = 0; round < 3; ++round) {
        for (unsigned i = 0; i < 25; ++i)
            stage.display->resize(1100 - i * 37 % 400, 300 + i * 53 % 500, 0.002 * (i % 4));
        const unsigned width = 940 + 20 * round, height = 500 + 30 * round;
        stage.display->resize(width, height);
        const Picture last = stage.display->picture_when([&](const Picture& now) { return now.width == width; });
        REQUIRE(last.width == width);
        REQUIRE(last.height == height);
        // Drawn into every corner: white background, not what the server fills new windows with.
        for (const unsigned y : {2U, height - kStatus - 3})
            CHECK(last.rgba[4 * (std::size_t{y} * width + width - 3)] == 255);
    }
    stage.display->ask_to_close();
    CHECK(viewer.wait() == 0);
    CHECK(viewer.err() == "");
}

namespace {

// What `frames` frames of a moving camera leave behind, by the statistics before and after them.
void check_growth(int frames) {
    const Stage stage(40);
    if (!stage.display) return;
    // Detail that follows the load of the machine would allocate at any time.
    std::string script = "set coarser off\nwait\npress left\n";
    const auto turn = [&](int count) {
        for (int i = 0; i < count; ++i)
            script += "move " + std::to_string(260 + i % 7 * 5) + " " + std::to_string(100 + i % 11 * 3) + "\n";
    };
    // The first frames make what later ones use again: resolutions, panels, lists.
    turn(300);
    script += "statistics before.json\n";
    turn(frames);
    script += "statistics after.json\nquit\n";
    write_text(stage.folder / "script.txt", script);
    RunningViewer viewer(stage.folder.path(), stage.display->name(),
                         {"knot.ply", "--device", "cpu", "--size", "420x300", "--script", "script.txt"});
    REQUIRE(viewer.wait(900) == 0);
    const auto before = nlohmann::json::parse(read_text(stage.folder / "before.json"));
    const auto after = nlohmann::json::parse(read_text(stage.folder / "after.json"));
    // The address sanitizer has a heap of its own: the C library's is empty, and memory that is freed is kept.
    const auto growth = [&](const char* name) {
#ifndef __SANITIZE_ADDRESS__
        REQUIRE(before.at(name).get<std::int64_t>() > 0);
#endif
        return after.at(name).get<std::int64_t>() - before.at(name).get<std::int64_t>();
    };
    WARN(frames << " frames: device " << growth("device_bytes") << ", heap " << growth("heap_bytes") << ", resident "
                << growth("resident_bytes") << " bytes, open files " << growth("open_files"));
    CHECK(growth("open_files") == 0);
    CHECK(growth("device_bytes") == 0);
#ifndef __SANITIZE_ADDRESS__
    CHECK(growth("heap_bytes") < 512 << 10);
    CHECK(growth("resident_bytes") < 4 << 20);
#endif
}

}  // namespace

TEST_CASE("frames of a moving camera leave no memory and no files behind") {
    check_growth(400);
}

TEST_CASE("ten thousand frames of a moving camera leave no memory and no files behind", "[.long]") {
    check_growth(10000);
}
