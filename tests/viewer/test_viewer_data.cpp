// The viewer's small parts: moving resolution, history of times, settings, the splice-capture line, saved scenes.
#include "engine/scene/scene_file.h"
#include "engine/viewer/capture_line.h"
#include "engine/viewer/compile_shader.h"
#include "engine/viewer/frame_times.h"
#include "engine/viewer/pass_history.h"
#include "engine/viewer/resolution.h"
#include "engine/viewer/settings_file.h"
#include "preprocess/model_format/error.h"
#include "tests/support/test_files.h"

#include <catch2/catch.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include <fstream>

using namespace splice;

TEST_CASE("slow frames coarsen the moving picture at once, down to half a side and no further") {
    MovingDetail resolution;
    CHECK(resolution.share() == 1);
    resolution.took(80);
    CHECK(resolution.share() == 0.75);
    for (int i = 0; i < 10; ++i)
        resolution.took(80);
    CHECK(resolution.share() == 0.5);
}

TEST_CASE("fast frames refine it after a while, and only if the finer picture would be fast enough") {
    MovingDetail resolution;
    for (int i = 0; i < 4; ++i)
        resolution.took(80);
    for (int i = 0; i < 50; ++i)
        resolution.took(MovingDetail::kTargetMs * 0.9);
    CHECK(resolution.share() == 0.5);
    resolution.took(2);
    CHECK(resolution.share() == 0.5);
    for (int i = 0; i < 200; ++i)
        resolution.took(2);
    CHECK(resolution.share() == 1);
    CHECK(resolution.tau() == 0);
}

TEST_CASE("where half the resolution is too slow, levels of detail grow coarser until the pace is kept") {
    MovingDetail detail;
    // A frame that takes 10 ms and 80 more at full detail, less the coarser it is.
    const auto frame_ms = [&] {
        return 10 + 80 * detail.share() * detail.share() / (1 + detail.tau() * detail.tau() / 4);
    };
    for (int i = 0; i < 40; ++i)
        detail.took(frame_ms());
    CHECK(detail.share() == 0.5);
    CHECK(detail.tau() >= 1);
    CHECK(frame_ms() <= MovingDetail::kTargetMs);
    // And it stays there.
    for (int i = 0; i < 500; ++i) {
        detail.took(frame_ms());
        CHECK(frame_ms() < 1.3 * MovingDetail::kTargetMs);
    }
    // A longer budget makes it finer again.
    for (int i = 0; i < 500; ++i)
        detail.took(frame_ms(), 200);
    CHECK(detail.tau() == 0);
    CHECK(detail.share() == 1);
    // Nothing is fast enough: as coarse as it gets, no coarser.
    for (int i = 0; i < 100; ++i)
        detail.took(1000);
    CHECK(detail.tau() == MovingDetail::kCoarsest);
}

TEST_CASE("levels of detail grow no coarser than they may, and are held where they may not at all") {
    MovingDetail detail;
    for (int i = 0; i < 100; ++i)
        detail.took(1000, MovingDetail::kTargetMs, 3);
    CHECK(detail.share() == 0.5);
    CHECK(detail.tau() == 3);
    detail.took(1000, MovingDetail::kTargetMs, 0);
    CHECK(detail.tau() == 0);
    for (int i = 0; i < 100; ++i)
        detail.took(1000, MovingDetail::kTargetMs, 0);
    CHECK(detail.tau() == 0);
    CHECK(detail.share() == 0.5);
}

TEST_CASE("a single slow frame, as shaders cause, does not make levels of detail coarser") {
    MovingDetail detail;
    detail.took(80);
    detail.took(80);
    REQUIRE(detail.share() == 0.5);
    for (int i = 0; i < 5; ++i) {
        detail.took(20);
        detail.took(400);
    }
    CHECK(detail.tau() == 0);
    detail.took(30);
    CHECK(detail.tau() > 0);
}

TEST_CASE("frame times: a median and a rate of the last thousand") {
    FrameTimes times;
    CHECK(times.frames_per_second() == 0);
    CHECK(times.median_ms() == 0);
    for (const double ms : {10.0, 30.0, 20.0})
        times.add(ms);
    CHECK(times.median_ms() == 20);
    CHECK(times.frames_per_second() == Approx(50));
    for (std::size_t i = 0; i < FrameTimes::kMost; ++i)
        times.add(5);
    CHECK(times.count() == FrameTimes::kMost);
    CHECK(times.frames_per_second() == Approx(200));
    times.clear();
    CHECK(times.count() == 0);
}

TEST_CASE("the history of passes is a ring, and forgets passes that no frame has any more") {
    PassHistory history;
    history.add({{"a", 1}, {"b", 2}});
    REQUIRE(history.series().size() == 2);
    for (std::size_t i = 0; i + 1 < PassHistory::kFrames; ++i)
        history.add({{"a", 3}});
    CHECK(history.series().size() == 2);
    CHECK(history.series()[1].ms[history.oldest()] == 2);
    history.add({{"a", 4}});
    REQUIRE(history.series().size() == 1);
    CHECK(history.series()[0].last == 4);
    const std::size_t newest = (history.oldest() + PassHistory::kFrames - 1) % PassHistory::kFrames;
    CHECK(history.series()[0].ms[newest] == 4);
}

TEST_CASE("settings come back as they were, and nonsense is the defaults") {
    ViewerSettings settings;
    settings.width = 801;
    settings.panels = false;
    settings.backend = "tile";
    settings.present_mode = "mailbox";
    const ViewerSettings back = parse_settings(write_settings(settings));
    CHECK(back.width == 801);
    CHECK_FALSE(back.panels);
    CHECK(back.backend == "tile");
    CHECK(back.present_mode == "mailbox");
    for (const char* text : {"", "[]", "{", R"({"width": -3, "height": 1e99, "panels": "yes", "backend": 7})",
                             R"({"width": "wide", "present_mode": null})"}) {
        const ViewerSettings defaults = parse_settings(text);
        CHECK(defaults.width == 1280);
        CHECK(defaults.height == 720);
        CHECK(defaults.panels);
        CHECK(defaults.backend == "auto");
    }
}

TEST_CASE("the line for splice-capture says everything, and quotes for a shell") {
    CaptureSettings settings;
    settings.width = 300;
    settings.height = 200;
    settings.camera.eye = {0.1, -2, 1.0 / 3};
    settings.sides = Sides::kTwoSided;
    const std::string line = capture_line({"it's.splice", "b c.ply"}, settings, {glm::dvec3(1, 0.5, 0), false});
    CHECK_THAT(line, Catch::StartsWith("splice-capture 'it'\\''s.splice' 'b c.ply' -o") &&
                         Catch::Contains("--size 300x200") && Catch::Contains("--eye=0.1,-2,0.3333333333333333") &&
                         Catch::Contains("--fov 40") && Catch::Contains("--two-sided") && Catch::Contains("'#ff8000'"));
    settings.camera.orthographic = true;
    settings.camera.orthographic_height = 2.5;
    CHECK_THAT(capture_line({"a"}, settings, {}), Catch::Contains("--orthographic --height 2.5"));
}

TEST_CASE("a saved scene reads back as the same scene") {
    SceneDescription scene;
    SceneModel file;
    file.source = std::filesystem::path("/models/sub/a.splice");
    file.transform.scale = 0.3;
    file.transform.rotation = glm::dmat3(glm::rotate(glm::dmat4(1.0), 2.1, glm::normalize(glm::dvec3(1, 2, 3))));
    file.transform.translation = {1, 0.1, -7};
    file.unit_box = true;
    SceneModel shape;
    shape.source = ShapeDescription{"torus-knot", {{"p", 2}, {"q", 5}}};
    shape.representation = SceneRepresentation::kSurfels;
    shape.max_spacing = 0.01;
    shape.selection = SceneSelection::kThesis;
    shape.sampling = 1.5;
    shape.bake_members = {"representation", "selection", "sampling", "max_spacing"};
    shape.transform.rotation = glm::dmat3(-1, 0, 0, 0, 1, 0, 0, 0, -1);  // half a turn
    scene.models = {file, shape};
    scene.camera = Camera{};
    scene.camera->eye = {1.0 / 3, 2, 3};
    scene.camera->orthographic = true;
    scene.camera->orthographic_height = 1.7;
    Light point;
    point.kind = LightKind::kPoint;
    point.position = {1, 2, 3};
    point.range = 4;
    point.colour = {1, 0.5, 0.25};
    scene.lighting.lights.push_back(point);
    scene.background.colour = glm::dvec3(32, 64, 128) / 255.0;
    scene.bookmarks = {{"front", *scene.camera}, {"a \"quoted\" name", Camera{}}};
    scene.look.view = View::kNormals;
    scene.look.shown = Shown::kTriangles;
    scene.look.backend = Backend::kPoint;
    scene.look.sides = Sides::kOneSided;
    scene.look.epsilon_scale = 0.7;
    scene.look.prefilter = false;
    scene.look.merge_px = 1.25;
    scene.look.tau = 2.5;
    scene.levels_from = Camera{};
    scene.comparison = {Comparison::kWipe, 0.25, {.view = View::kDepth, .shown = Shown::kSurfels, .antialias = 2}};
    scene.lighting.highlight = HighlightModel::kPhong;
    scene.lighting.rim = 0.3;
    scene.lighting.rim_exponent = 5;
    scene.width = 77;

    const std::string text = write_scene(scene, "/models");
    const SceneDescription back = parse_scene(text, "saved.json", "/models");
    INFO(text);
    REQUIRE(back.models.size() == 2);
    CHECK(std::get<std::filesystem::path>(back.models[0].source).lexically_normal() == "/models/sub/a.splice");
    CHECK(back.models[0].transform.scale == 0.3);
    CHECK(back.models[0].transform.translation == file.transform.translation);
    CHECK(back.models[0].unit_box);
    for (std::size_t i = 0; i < 2; ++i)
        for (int column = 0; column < 3; ++column)
            CHECK(glm::length(back.models[i].transform.rotation[column] - scene.models[i].transform.rotation[column]) <
                  1e-12);
    CHECK(std::get<ShapeDescription>(back.models[1].source).parameters.at("q") == 5);
    CHECK(back.models[1].representation == SceneRepresentation::kSurfels);
    CHECK(back.models[1].max_spacing == 0.01);
    CHECK(back.models[1].selection == SceneSelection::kThesis);
    CHECK(back.models[1].sampling == 1.5);
    CHECK(back.models[1].bake_members == shape.bake_members);
    REQUIRE(back.camera);
    CHECK(*back.camera == *scene.camera);
    REQUIRE(back.lighting.lights.size() == 2);
    CHECK(back.lighting.lights[1].range == 4);
    CHECK(back.lighting.lights[1].colour == point.colour);
    CHECK(glm::length(back.background.colour - scene.background.colour) < 1e-12);
    REQUIRE(back.bookmarks.size() == 2);
    CHECK(back.bookmarks[1].name == "a \"quoted\" name");
    CHECK(back.bookmarks[0].camera == *scene.camera);
    CHECK(back.lighting == scene.lighting);
    CHECK(back.look.view == View::kNormals);
    CHECK(back.look.shown == Shown::kTriangles);
    CHECK(back.look.backend == Backend::kPoint);
    CHECK(back.look.sides == Sides::kOneSided);
    CHECK(back.look.epsilon_scale == 0.7);
    CHECK_FALSE(back.look.prefilter);
    CHECK(back.look.merge_px == 1.25);
    CHECK(back.look.tau == 2.5);
    REQUIRE(back.levels_from);
    CHECK(*back.levels_from == *scene.levels_from);
    CHECK(back.comparison.kind == Comparison::kWipe);
    CHECK(back.comparison.wipe == 0.25);
    CHECK(back.comparison.right.view == View::kDepth);
    CHECK(back.comparison.right.shown == Shown::kSurfels);
    CHECK(back.comparison.right.antialias == 2);
    CHECK(back.width == 77);
}

TEST_CASE("bookmarks need names of their own and placed cameras") {
    const auto parse = [](const std::string& bookmarks) {
        return parse_scene(R"({"models": [{"file": "a"}], "bookmarks": )" + bookmarks + "}", "s.json", "");
    };
    const std::string camera = R"("camera": {"eye": [0,0,1], "target": [0,0,0]})";
    CHECK(parse("[{\"name\": \"a\", " + camera + "}]").bookmarks.size() == 1);
    CHECK_THROWS_WITH(parse("[{\"name\": \"a\", " + camera + "}, {\"name\": \"a\", " + camera + "}]"),
                      Catch::Contains("/bookmarks/1/name"));
    CHECK_THROWS_WITH(parse("[{\"name\": \"\", " + camera + "}]"), Catch::Contains("/bookmarks/0/name"));
    CHECK_THROWS_WITH(parse(R"([{"name": "a", "camera": {"azimuth": 3}}])"), Catch::Contains("/bookmarks/0/camera"));
}

TEST_CASE("shaders compile within the program, mistakes are told with file and line") {
    const std::filesystem::path folder = test::source_file("shaders/glsl");
    const auto words = compile_shader(folder / "triangle.frag", folder / "include");
    REQUIRE(words.size() > 100);
    CHECK(words[0] == 0x07230203U);
    const test::TemporaryFolder temporary;
    std::ofstream(temporary / "wrong.frag") << "#version 460\nvoid main() {\n  nothing = 1;\n}\n";
    CHECK_THROWS_WITH(compile_shader(temporary / "wrong.frag", folder / "include"),
                      Catch::Contains("wrong.frag:3") && Catch::Contains("nothing"));
    std::ofstream(temporary / "lost.frag") << "#version 460\n#extension GL_GOOGLE_include_directive : "
                                              "require\n#include \"nowhere.glsl\"\nvoid main() {}\n";
    CHECK_THROWS_WITH(compile_shader(temporary / "lost.frag", folder / "include"), Catch::Contains("nowhere.glsl"));
    CHECK_THROWS_AS(compile_shader(temporary / "absent.frag", folder / "include"), SystemError);
}
