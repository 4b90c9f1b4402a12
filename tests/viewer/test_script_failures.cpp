// Scripts whose actions fail: each is told with its line, the rest is done, and the run has failed.
#include "tests/cli/spawn.h"
#include "tests/viewer/running_viewer.h"

#include <catch2/catch.hpp>
#include <sys/stat.h>
#include <unistd.h>

#include <cstdio>

using namespace splice;
using namespace splice::test;

TEST_CASE("actions that fail are told with file and line, what follows is done, and the exit code is 1") {
    const Stage stage(40);
    if (!stage.display) return;
    write_text(stage.folder / "broken.ply", "ply\nformat nonsense\n");
    struct Failing {
        const char* script;
        const char* said;
    };
    for (const Failing& failing : {Failing{"wait\nset epsilon 1000\n", "line 2: set epsilon: expected a number from 0"},
                                   Failing{"wait\nopen missing.ply\nwait\n", "line 2: cannot read missing.ply"},
                                   Failing{"wait\n\ndrop broken.ply\nwait\n", "line 3: broken.ply"},
                                   Failing{"wait\nscreenshot nowhere/a.png\n", "line 2: nowhere/a.png"},
                                   Failing{"wait\nturntable 3 nowhere/a.png\nwait\n", "line 2: nowhere/a-000.png"},
                                   Failing{"wait\ngo home\n", "line 2: no bookmark \"home\""}}) {
        INFO(failing.script);
        std::filesystem::remove(stage.folder / "after.png");
        const auto [code, err] =
            stage.run_script(std::string(failing.script) + "screenshot after.png\nquit\n", "600x400");
        CHECK(code == 1);
        CHECK(line_count(err) == 1);
        CHECK_THAT(err, Catch::StartsWith("splice-view: script.txt: ") && Catch::Contains(failing.said));
        CHECK(std::filesystem::exists(stage.folder / "after.png"));
    }
    const auto key = stage.run_script("wait\nkey r\nquit\n", "600x400", {});
    CHECK(key.code == 1);
    CHECK_THAT(key.err, Catch::Contains("script.txt: line 2: rebake: nothing is open"));
}

TEST_CASE("what was to be opened first and cannot be is a failure of a script's run, too") {
    const Stage stage(40);
    if (!stage.display) return;
    const auto [code, err] = stage.run_script("wait\nquit\n", "600x400", {"missing.ply"});
    CHECK(code == 1);
    CHECK(err == "splice-view: cannot read missing.ply: No such file or directory\n");
}

// A pipe that nobody writes to is read for ever.
TEST_CASE("while a file is read that takes for ever, the camera moves, and another file is opened in its place") {
    const Stage stage(40);
    if (!stage.display) return;
    const std::filesystem::path pipe = stage.folder / "slow.ply";
    REQUIRE(mkfifo(pipe.c_str(), 0600) == 0);
    write_mesh_file(stage.folder / "other.ply", 60);
    RunningViewer viewer(stage.folder.path(), stage.display->name(),
                         {"knot.ply", "--device", "cpu", "--validate", "--size", "800x600"});
    stage.wait_for("knot.ply");
    REQUIRE(stage.display->drop(pipe, 500, 300));
    REQUIRE(stage.display->wait_for_title("loading slow.ply - splice-view"));
    const Picture loading = stage.display->still_picture();
    stage.display->drag(500, 300, 560, 320);
    CHECK(difference(scene_part(stage.display->still_picture()), scene_part(loading)) > 0.02);
    CHECK(stage.display->title() == "loading slow.ply - splice-view");

    REQUIRE(stage.display->drop(stage.folder / "other.ply", 500, 300));
    REQUIRE(stage.display->wait_for_title("other.ply - splice-view"));
    const Picture shown = stage.display->still_picture();
    stage.display->drag(500, 300, 560, 320);
    CHECK(difference(scene_part(stage.display->still_picture()), scene_part(shown)) > 0.02);
    stage.display->ask_to_close();
    // Now somebody writes, nothing, and the reader notices that it is not wanted.
    int code = -1;
    for (int i = 0; i < 400 && code < 0; ++i) {
        std::FILE* const writer = std::fopen(pipe.c_str(), "r+");
        code = viewer.wait(0.05);
        std::fclose(writer);
    }
    CHECK(code == 0);
    CHECK(viewer.err() == "");
}
