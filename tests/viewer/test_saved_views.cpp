// What is shown can be shown again: by the command line that is copied, by the scene that is saved.
#include "engine/capture/png_file.h"
#include "preprocess/mesh/shapes.h"
#include "preprocess/mesh/write_mesh.h"
#include "tests/cli/spawn.h"
#include "tests/viewer/running_viewer.h"

#include <catch2/catch.hpp>

#include <optional>
#include <string>

using namespace splice;
using namespace splice::test;

namespace {

// Beside the knot, which is around the origin.
void write_second_mesh(const std::filesystem::path& path) {
    SourceMesh mesh = shapes::ico_sphere(12);
    for (auto& position : mesh.positions)
        position[0] += 3;
    write_ply(mesh, path);
}

std::size_t scenes_in(const std::filesystem::path& folder) {
    std::size_t count = 0;
    for (const auto& entry : std::filesystem::directory_iterator(folder))
        count += entry.path().extension() == ".json" ? 1 : 0;
    return count;
}

}  // namespace

TEST_CASE("the copied command line makes the same picture of several files, and of what was baked anew") {
    const Stage stage;
    if (!stage.display) return;
    const auto& [display, folder] = stage;
    write_model_file(folder / "knot.ply", folder / "knot.splice");
    write_second_mesh(folder / "it's a ball.ply");
    const auto [code, err] = stage.run_script(
        "wait\ndrag left 600 300 640 320\nset merge 2\nset tau 1.5\nset show hybrid\nwait\n"
        "screenshot two.png\ncamera-line two.txt\n"
        "set bake surfels\nset sampling 1.5\nset merge 0\nset tau 0\nrebake\nwait\n"
        "screenshot dense.png\ncamera-line dense.txt\n"
        "set bake hybrid\nset selection thesis\nset sampling adaptive\nset spacing 0.01\nrebake\nwait\n"
        "screenshot thesis.png\ncamera-line thesis.txt\n"
        "set tau 4\nset freeze on\nframes 2\ndrag left 600 300 500 320\nwait\n"
        "screenshot frozen.png\ncamera-line frozen.txt\nquit\n",
        "900x600", {"knot.splice", "it's a ball.ply"});
    CHECK(code == 0);
    CHECK(err == "");
    for (const char* name : {"two", "dense", "thesis", "frozen"}) {
        INFO(name);
        CHECK(difference(read_png(folder / (std::string(name) + ".png")),
                         captured_by(folder.path(), read_text(folder / (std::string(name) + ".txt")))) == 0);
    }
    // Only what a line cannot say is saved for it.
    CHECK_THAT(read_text(folder / "two.txt"), Catch::Contains("knot.splice' '") && Catch::Contains("--merge 2 "));
    CHECK_THAT(read_text(folder / "dense.txt"), Catch::Contains("/splice-view.json'"));
    CHECK(scenes_in(folder.path()) == 3);
    CHECK(difference(read_png(folder / "dense.png"), read_png(folder / "two.png")) > 0.005);
    CHECK(difference(read_png(folder / "thesis.png"), read_png(folder / "dense.png")) > 0.005);
}

TEST_CASE("merging of the command line goes before what the first scene says, not before those that are opened later") {
    const Stage stage(40);
    if (!stage.display) return;
    write_text(stage.folder / "merged.json", R"({"models": [{"file": "knot.ply"}], "render": {"merge": 2}})");
    const auto [code, err] =
        stage.run_script("wait\ncamera-line first.txt\nopen merged.json\nwait\ncamera-line later.txt\nquit\n",
                         "600x400", {"merged.json", "--merge", "4"});
    CHECK(code == 0);
    CHECK(err == "");
    CHECK_THAT(read_text(stage.folder / "first.txt"), Catch::Contains("--merge 4 "));
    CHECK_THAT(read_text(stage.folder / "later.txt"), Catch::Contains("--merge 2 "));
    const auto mesh = stage.run_script("wait\ncamera-line mesh.txt\nset edited right\ncamera-line right.txt\nquit\n",
                                       "600x400", {"knot.ply", "--merge", "0"});
    CHECK(mesh.code == 0);
    for (const char* name : {"mesh.txt", "right.txt"})
        CHECK_THAT(read_text(stage.folder / name), Catch::Contains("--merge 0 "));
}

TEST_CASE("the copied command line is on the clipboard") {
    const Stage stage(40);
    if (!stage.display) return;
    RunningViewer viewer(stage.folder.path(), stage.display->name(),
                         {"knot.ply", "--device", "cpu", "--validate", "--size", "800x600"});
    stage.wait_for("knot.ply");
    stage.display->drag(500, 300, 540, 330);
    stage.display->still_picture();
    stage.display->key("c");
    stage.display->picture_when([&](const Picture&) { return viewer.out().find("clipboard") != std::string::npos; });
    const std::optional<std::string> line = stage.display->clipboard();
    REQUIRE(line);
    stage.display->key("p");
    stage.display->picture_when(
        [&](const Picture&) { return std::filesystem::exists(stage.folder / "splice-view.png"); });
    CHECK(difference(captured_by(stage.folder.path(), *line), read_png(stage.folder / "splice-view.png")) == 0);
    stage.display->ask_to_close();
    CHECK(viewer.wait() == 0);
}

TEST_CASE("a saved scene opens to the same picture: representation, backend, bake, lights, levels, comparison") {
    const Stage stage;
    if (!stage.display) return;
    const auto& [display, folder] = stage;
    write_text(folder / "lit.json",
               R"({"models": [{"file": "knot.ply"}], "lighting": {"ambient": 0.2, "specular": 0.4, "highlight": "phong",
                   "rim": 0.5, "rim_exponent": 2, "lights": [{"type": "directional", "direction": [1, -1, -1]}]}})");
    const auto saved = stage.run_script(
        "wait\nset bake surfels\nset sampling 0.8\nrebake\nwait\n"
        "drag left 600 300 640 320\nset backend sprite\nset epsilon 0.7\nset antialias 2\nset merge 0\n"
        "compare wipe\nset wipe 0.3\nset edited right\nset show triangles\nset view normals\nset edited left\nwait\n"
        "screenshot left.png\nset edited right\nscreenshot right.png\nset edited left\n"
        "key escape\nwait\nscreenshot-window window.png\nsave-scene saved.json\n"
        "compare off\nset show surfels\nset tau 6\nset freeze on\nframes 2\ndrag left 600 300 500 320\nwait\n"
        "screenshot frozen.png\nsave-scene frozen.json\nquit\n",
        "900x600", {"lit.json"});
    CHECK(saved.code == 0);
    CHECK(saved.err == "");
    const auto opened = stage.run_script(
        "wait\nscreenshot left2.png\nset edited right\nscreenshot right2.png\nset edited left\nkey escape\nwait\n"
        "screenshot-window window2.png\nsave-scene again.json\n"
        "open frozen.json\nwait\nscreenshot frozen2.png\nquit\n",
        "900x600", {"saved.json"});
    CHECK(opened.code == 0);
    CHECK(opened.err == "");
    for (const char* name : {"left", "right", "frozen"}) {
        INFO(name);
        CHECK(difference(read_png(folder / (std::string(name) + ".png")),
                         read_png(folder / (std::string(name) + "2.png"))) == 0);
    }
    CHECK(difference(read_png(folder / "left.png"), read_png(folder / "right.png")) > 0.02);
    CHECK(difference(scene_part(read_png(folder / "window.png")), scene_part(read_png(folder / "window2.png"))) == 0);
    // The line says what cannot be seen, and another program reads it.
    CHECK_THAT(read_text(folder / "saved.json"), Catch::Contains("\"backend\": \"sprite\"") &&
                                                     Catch::Contains("\"sampling\": 0.8") &&
                                                     Catch::Contains("\"kind\": \"wipe\""));
    for (const char* name : {"left", "frozen"}) {
        const std::string scene = name == std::string("left") ? "saved.json" : "frozen.json";
        const Outcome outcome = run({program("splice-capture"), {scene, "-o", "captured.png"}, folder.path()});
        INFO(scene << outcome.err);
        REQUIRE(outcome.exit_code == 0);
        CHECK(difference(read_png(folder / "captured.png"), read_png(folder / (std::string(name) + ".png"))) == 0);
    }
}

TEST_CASE("the bake panel starts from how the scene is baked, and baking anew changes nothing then") {
    const Stage stage;
    if (!stage.display) return;
    const auto& [display, folder] = stage;
    write_text(folder / "fine.json",
               R"({"models": [{"file": "knot.ply", "representation": "surfels", "max_spacing": 0.01}]})");
    const auto [code, err] = stage.run_script(
        "wait\nscreenshot before.png\nrebake\nwait\nscreenshot after.png\nopen knot.ply\nwait\nrebake\nwait\n"
        "save-scene plain.json\nquit\n",
        "900x600", {"fine.json"});
    CHECK(code == 0);
    CHECK(err == "");
    CHECK(difference(read_png(folder / "before.png"), read_png(folder / "after.png")) == 0);
    CHECK_THAT(read_text(folder / "plain.json"), !Catch::Contains("max_spacing"));
}

TEST_CASE("keys write new files and leave those that are there") {
    const Stage stage(40);
    if (!stage.display) return;
    write_text(stage.folder / "splice-view.png", "precious");
    const auto [code, err] = stage.run_script("wait\nkey p\nkey keypad-7\nwait\nkey p\nwait\nquit\n");
    CHECK(code == 0);
    CHECK(err == "");
    CHECK(read_text(stage.folder / "splice-view.png") == "precious");
    CHECK(difference(read_png(stage.folder / "splice-view-1.png"), read_png(stage.folder / "splice-view-2.png")) >
          0.02);
}
