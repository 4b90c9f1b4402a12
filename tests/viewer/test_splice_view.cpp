// splice-view in a real window on a display of the test's own, with real input events, on a software device.
#include "engine/capture/png_file.h"
#include "engine/scene/view.h"
#include "tests/cli/spawn.h"
#include "tests/viewer/running_viewer.h"

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include <utility>
#include <vector>

using namespace splice;
using namespace splice::test;

TEST_CASE("without a display it says so in a line and points to splice-capture") {
    const TemporaryFolder folder;
    const Outcome outcome = run({.program = program("splice-view"), .environment = {"DISPLAY", "WAYLAND_DISPLAY"}});
    CHECK(outcome.exit_code == 1);
    CHECK(line_count(outcome.err) == 1);
    CHECK_THAT(outcome.err, Catch::StartsWith("splice-view: no display") && Catch::Contains("splice-capture"));
}

TEST_CASE("real input: load, orbit, zoom, resize, every view, drop, bake anew, screenshot, close") {
    const Stage stage;
    if (!stage.display) return;
    const auto& [display, folder] = stage;
    write_model_file(folder / "knot.ply", folder / "knot.splice");
    write_mesh_file(folder / "dropped.ply", 120);  // long enough to bake that the title can be seen to change
    RunningViewer viewer(folder.path(), display->name(),
                         {"knot.splice", "--device", "cpu", "--validate", "--size", "1000x700"});
    stage.wait_for("knot.splice");

    // Loaded: something is there beside the background, and the interface stands where it should.
    const Picture loaded = display->still_picture();
    REQUIRE(loaded.width == 1000);
    REQUIRE(loaded.height == 700);
    const Picture scene = scene_part(loaded);
    const Picture empty{scene.width, scene.height, std::vector<std::uint8_t>(scene.rgba.size(), 255)};
    CHECK(difference(scene, empty) > 0.05);
    CHECK(difference(scene, empty) < 0.9);

    SECTION("the camera") {
        display->drag(600, 300, 700, 340);
        const Picture turned = display->still_picture();
        CHECK(difference(scene_part(turned), scene) > 0.03);
        display->move(650, 320);
        display->wheel(3);
        const Picture zoomed = display->still_picture();
        CHECK(difference(scene_part(zoomed), empty) > difference(scene_part(turned), empty) * 1.2);
        display->drag(600, 300, 640, 300, 2);
        CHECK(difference(scene_part(display->still_picture()), scene_part(zoomed)) > 0.03);
        display->key("f");
        display->key("1");
        const Picture front = display->still_picture();
        display->key("7");
        const Picture top = display->still_picture();
        display->key("KP_1");
        CHECK(difference(scene_part(display->still_picture()), scene_part(front)) == 0);
        display->key("KP_7");
        CHECK(difference(scene_part(display->still_picture()), scene_part(top)) == 0);
        CHECK(difference(scene_part(front), scene_part(top)) > 0.03);
        display->key("5");
        CHECK(difference(scene_part(display->still_picture()), scene_part(top)) > 0.005);
    }

    SECTION("sizes") {
        for (const auto& [width, height] : {std::pair{640U, 480U}, {1200U, 800U}}) {
            display->resize(width, height);
            const Picture resized = display->picture_when(
                [&, w = width](const Picture& now) { return now.width == w && difference(now, now) == 0; });
            CHECK(resized.width == width);
            CHECK(resized.height == height);
            const Picture right = cropped(resized, width - 200, 0, 200, height - kStatus);
            // Drawn up to the edge: white background, not what the server fills new windows with.
            const std::size_t corner = (std::size_t{4} * 199) + (std::size_t{4} * 200 * 2);
            CHECK(right.rgba[corner] == 255);
        }
    }

    SECTION("views") {
        std::vector<Picture> seen{scene};
        for (std::size_t i = 1; i < kViewNames.size(); ++i) {
            display->key("v");
            // A view's first picture may take long: its shaders are compiled.
            seen.push_back(scene_part(display->picture_when(
                [&](const Picture& now) { return difference(scene_part(now), seen.back()) > 0.001; })));
        }
        for (std::size_t i = 0; i < seen.size(); ++i)
            for (std::size_t j = i + 1; j < seen.size(); ++j) {
                INFO("views " << i << " and " << j);
                CHECK(difference(seen[i], seen[j]) > 0.001);
            }
        display->key("v");
        CHECK(difference(scene_part(display->still_picture()), scene) == 0);
    }

    SECTION("files") {
        write_text(folder / "broken.ply", "ply\nformat nonsense\n");
        REQUIRE(display->drop(folder / "broken.ply", 600, 300));
        const Picture with_message =
            display->picture_when([&](const Picture& now) { return difference(scene_part(now), scene) > 0.005; });
        CHECK(difference(scene_part(with_message), scene) > 0.005);
        CHECK(display->title() == "knot.splice - splice-view");
        display->key("Escape");

        REQUIRE(display->drop(folder / "dropped.ply", 600, 300));
        REQUIRE(display->wait_for_title("dropped.ply - splice-view"));
        const Picture dropped = display->still_picture();
        CHECK(difference(scene_part(dropped), scene) > 0.03);
        display->key("r");
        REQUIRE(display->wait_for_title("loading dropped.ply - splice-view", 10));
        REQUIRE(display->wait_for_title("dropped.ply - splice-view"));
        CHECK(difference(scene_part(display->still_picture()), scene_part(dropped)) == 0);
        CHECK_THAT(viewer.err(), Catch::Contains("broken.ply"));
    }

    SECTION("screenshot") {
        display->drag(600, 300, 540, 280);
        const Picture turned = display->still_picture();
        display->key("p");
        display->picture_when([&](const Picture&) { return std::filesystem::exists(folder / "splice-view.png"); });
        CHECK(difference(read_png(folder / "splice-view.png"), scene_part(turned)) == 0);
        display->key("Escape");
        display->key("Tab");
        const Picture alone = display->still_picture();
        display->key("p");
        display->picture_when([&](const Picture&) { return std::filesystem::exists(folder / "splice-view-1.png"); });
        const Picture taken = read_png(folder / "splice-view-1.png");
        CHECK(taken.width == 1000);
        CHECK(difference(cropped(taken, 0, 0, 1000, 400), cropped(alone, 0, 0, 1000, 400)) == 0);
    }

    display->ask_to_close();
    CHECK(viewer.wait() == 0);
    // The broken file's line is the only thing that may be said.
    const std::string err = viewer.err();
    CHECK((err.empty() || (line_count(err) == 1 && err.find("broken.ply") != std::string::npos)));
    CHECK(std::filesystem::exists(folder / "splice" / "view.json"));
}

TEST_CASE("a script does the same, and its screenshots are splice-capture's pictures of the same camera") {
    const Stage stage;
    if (!stage.display) return;
    const auto& [display, folder] = stage;
    write_model_file(folder / "knot.ply", folder / "knot.splice");
    write_text(folder / "tour.txt",
               "# every kind of hand\n"
               "wait\n"
               "drag left 600 300 700 350\n"
               "move 640 300\nwheel 2\n"
               "drag middle 600 300 620 310 3\n"
               "wait\n"
               "screenshot turned.png\nscreenshot-window window.png\ncamera-line turned.txt\n"
               "key 5\nset epsilon 0.8\nset background \"#203040\"\nview depth\nwait\n"
               "screenshot depth.png\ncamera-line depth.txt\n"
               "view shaded\nset antialias 2\nset tau 3\nwait\nscreenshot smooth.png\ncamera-line smooth.txt\n"
               "set antialias 1\nset tau 0\n"
               "set show triangles\nkey control+3\nwait\nscreenshot side.png\ncamera-line side.txt\n"
               "compare wipe\nset wipe 0.25\nwait\nscreenshot-window wipe.png\n"
               "compare side-by-side\nwait\nscreenshot-window both.png\ncompare off\n"
               "bookmark here\nkey 1\ngo here\nwait\nscreenshot again.png\nsave-scene saved.json\n"
               "turntable 3 turn.png\nwait\n"
               "click left 650 330\nframes 20\nquit\n");
    RunningViewer viewer(
        folder.path(), display->name(),
        {"knot.splice", "--device", "cpu", "--validate", "--size", "1000x700", "--script", "tour.txt"});
    REQUIRE(viewer.wait() == 0);
    CHECK(viewer.err() == "");
    for (const char* name : {"turned", "depth", "smooth", "side"}) {
        INFO(name);
        const Picture shot = read_png(folder / (std::string(name) + ".png"));
        CHECK(shot.width == 1000 - kPanel);
        CHECK(difference(shot, captured_by(folder.path(), read_text(folder / (std::string(name) + ".txt")))) == 0);
    }
    const Picture turned = read_png(folder / "turned.png");
    CHECK(difference(scene_part(read_png(folder / "window.png")), turned) == 0);
    CHECK(difference(read_png(folder / "side.png"), turned) > 0.02);
    CHECK(difference(read_png(folder / "again.png"), read_png(folder / "side.png")) == 0);
    CHECK(difference(read_png(folder / "turn-000.png"), read_png(folder / "side.png")) == 0);
    CHECK(difference(read_png(folder / "turn-001.png"), read_png(folder / "turn-002.png")) > 0.02);

    // The saved scene shows what the window showed.
    const Outcome outcome = run({program("splice-capture"), {"saved.json", "-o", "saved.png"}, folder.path()});
    INFO(outcome.err);
    REQUIRE(outcome.exit_code == 0);
    CHECK(difference(read_png(folder / "saved.png"), read_png(folder / "side.png")) == 0);
    CHECK_THAT(read_text(folder / "saved.json"), Catch::Contains("\"here\""));
}

TEST_CASE("of a model larger than --memory no more is held, and pictures become whole while they are shown") {
    const Stage stage(800);
    if (!stage.display) return;
    const auto& [display, folder] = stage;
    const Outcome baked = run({program("splice-bake"),
                               {(folder / "knot.ply").string(), "-o", (folder / "knot.splice").string(),
                                "--representation", "surfels", "--h-max", "0.004", "--quiet"}});
    REQUIRE(baked.exit_code == 0);
    write_text(folder / "script.txt",
               "wait\nstatistics far.json\nscreenshot-window far-window.png\nscreenshot far.png\nkey escape\n"
               "drag left 600 300 700 350\nmove 640 300\nwheel 6\nwait\nstatistics near.json\n"
               "screenshot-window near-window.png\nscreenshot near.png\nquit\n");
    RunningViewer viewer(folder.path(), display->name(),
                         {"knot.splice", "--device", "cpu", "--validate", "--memory", "1", "--size", "1000x700",
                          "--script", "script.txt"});
    REQUIRE(viewer.wait() == 0);
    CHECK(viewer.err() == "");
    constexpr std::uint64_t kLimit = 1 << 20;
    for (const char* name : {"far", "near"}) {
        INFO(name);
        const auto pages = nlohmann::json::parse(read_text(folder / (std::string(name) + ".json"))).at("pages");
        CHECK(pages.at("limit_bytes") == kLimit);
        CHECK(pages.at("resident_bytes") <= kLimit);
        // From afar triangles of the whole model may stand for all surfels.
        if (name == std::string("near")) {
            CHECK(pages.at("resident_bytes") > 0);
            CHECK(pages.at("blocks_read") > 0);
        }
        const Picture window = read_png(folder / (std::string(name) + "-window.png"));
        CHECK(difference(scene_part(window), read_png(folder / (std::string(name) + ".png"))) == 0);
    }
}

TEST_CASE("usage: what is not understood ends the run with 2 before a window opens") {
    struct Wrong {
        std::vector<std::string> arguments;
        std::string said;
    };
    for (const Wrong& wrong : {Wrong{{"--present-mode", "fast"}, "--present-mode"}, Wrong{{"--size", "0x3"}, "--size"},
                               Wrong{{"--merge", "65"}, "--merge"}, Wrong{{"--merge", "nan"}, "--merge"},
                               Wrong{{"--memory", "nan"}, "--memory"}, Wrong{{"--nonsense"}, "--nonsense"}}) {
        const Outcome outcome = run({program("splice-view"), wrong.arguments});
        CHECK(outcome.exit_code == 2);
        CHECK(line_count(outcome.err) == 1);
        CHECK_THAT(outcome.err, Catch::Contains(wrong.said));
    }
    CHECK(run({program("splice-view"), {"--help"}}).exit_code == 0);
}
