// splice-capture as a user meets it: pictures, options, statistics.
#include "engine/capture/png_file.h"
#include "tests/engine/capture_program.h"
#include "tests/engine/handmade_model.h"

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>

using namespace splice;
using namespace splice::test;

TEST_CASE("levels of detail: by the command line, else by the scene, budgets and costs are in the statistics") {
    const TemporaryFolder folder;
    // Two colours that blend where they meet, by the kernel.
    HandmadeModel model;
    auto surfels = sheet({-0.5f, -0.5f, 0}, {0.5f, 0, 0}, {0, 1, 0}, 8, kRed);
    const auto others = sheet({0, -0.5f, 0}, {0.5f, 0, 0}, {0, 1, 0}, 8, kGreen);
    surfels.insert(surfels.end(), others.begin(), others.end());
    model.add_surfels(surfels);
    model.add_triangles(quad({0.6f, -0.5f, 0}, {0.3f, 0, 0}, {0, 1, 0}, kGreen));
    write_model(view_of(model.model()), folder / "a.splice");
    write_text(folder / "scene.json",
               R"({"models": [{"file": "a.splice"}], "render": {"tau": 3, "kernel": "gaussian:0.8"}})");
    const auto stats = [&](std::vector<std::string> arguments) {
        arguments.insert(arguments.end(), {"-o", "a.png", "--size", "40x30", "--stats", "a.json"});
        const Outcome outcome = capture(folder, arguments);
        CHECK(outcome.err == "");
        REQUIRE(outcome.exit_code == 0);
        return nlohmann::json::parse(read_text(folder / "a.json"));
    };
    const auto chosen = stats({"scene.json"});
    CHECK(chosen["cut"]["tau"] == 3);
    for (const char* count : {"visited", "outside_frustum", "facing_away", "ellipses", "merged_surfels", "surfels",
                              "patches_by_triangles", "groups_by_triangles"})
        CHECK(chosen["cut"].at(count).get<int>() >= 0);
    for (const char* time : {"select_ms", "gather_ms"})
        CHECK(chosen["cut"].at(time).get<double>() > 0);
    const std::string wide = read_text(folder / "a.png");
    CHECK(stats({"scene.json", "--kernel", "disk", "--tau", "1"})["cut"]["tau"] == 1);
    CHECK(read_text(folder / "a.png") != wide);
    const auto plain = stats({"a.splice"});
    CHECK_FALSE(plain.contains("cut"));
    CHECK(plain["predicted_ms"] > 0);
    CHECK(plain["costs_us"]["calibrated"] == false);
    const auto budget = stats({"a.splice", "--budget", "1000", "--calibrate"});
    CHECK(budget["cut"]["budget_ms"] == 1000);
    CHECK(budget["cut"]["tau"] == 0);
    CHECK(budget["costs_us"]["calibrated"] == true);
    CHECK(capture(folder, {"a.splice", "-o", "a.png", "--budget", "0"}).exit_code == 2);
}

TEST_CASE("shading and samples are chosen on the command line, else by the scene") {
    const TemporaryFolder folder;
    write_small_model(folder / "a.splice");
    write_text(folder / "scene.json",
               R"({"models": [{"file": "a.splice"}], "render": {"shading": "deferred", "antialias": 2}})");
    const auto stats = [&](std::vector<std::string> arguments) {
        arguments.insert(arguments.end(), {"-o", "a.png", "--size", "40x30", "--stats", "a.json"});
        const Outcome outcome = capture(folder, arguments);
        CHECK(outcome.err == "");
        REQUIRE(outcome.exit_code == 0);
        const Picture picture = read_png(folder / "a.png");
        CHECK(picture.width == 40);
        CHECK(picture.height == 30);
        const auto json = nlohmann::json::parse(read_text(folder / "a.json"));
        return std::pair{json["shading"].get<std::string>(), json["antialias"].get<int>()};
    };
    CHECK(stats({"a.splice"}) == std::pair<std::string, int>("surfel", 1));
    CHECK(stats({"scene.json"}) == std::pair<std::string, int>("deferred", 2));
    CHECK(stats({"scene.json", "--shading", "surfel", "--antialias", "4"}) == std::pair<std::string, int>("surfel", 4));
    for (const std::vector<std::string>& wrong : std::vector<std::vector<std::string>>{
             {"--shading", "cel"}, {"--antialias", "0"}, {"--antialias", "9"}, {"--antialias", "1.5"}}) {
        std::vector<std::string> arguments{"a.splice", "-o", "b.png"};
        arguments.insert(arguments.end(), wrong.begin(), wrong.end());
        const Outcome outcome = capture(folder, arguments);
        CHECK(outcome.exit_code == 2);
        CHECK(line_count(outcome.err) == 1);
        CHECK_THAT(outcome.err, Catch::Contains(wrong.front()));
    }
}

TEST_CASE("a model becomes a picture of the size asked for, with its statistics") {
    const TemporaryFolder folder;
    write_small_model(folder / "a.splice");
    const Outcome outcome =
        capture(folder, {"a.splice", "-o", "a.png", "--size", "120x80", "--backend", "sprite", "--stats", "a.json"});
    CHECK(outcome.exit_code == 0);
    CHECK(outcome.err == "");
    const Picture picture = read_png(folder / "a.png");
    CHECK(picture.width == 120);
    CHECK(picture.height == 80);
    const auto stats = nlohmann::json::parse(read_text(folder / "a.json"));
    CHECK(stats.at("device").is_string());
    CHECK(stats.at("frame_ms").get<double>() > 0);
    CHECK(stats.at("surfels_drawn") == 81);
    CHECK(stats.at("triangles_drawn") == 2);
    CHECK(stats.at("patches").at("drawn") == 2);
    CHECK(stats.at("patches").at("outside_frustum") == 0);
    CHECK(stats.at("resident").at("surfel_bytes").get<std::size_t>() >= 81 * sizeof(format::Surfel));
    CHECK(stats.at("resident").at("triangle_bytes") == 6 * sizeof(format::Vertex) + 6 * sizeof(std::uint32_t));
    CHECK(stats.at("resident").at("device_bytes").get<std::size_t>() > 81 * sizeof(format::Surfel) + 120 * 80 * 4);
    CHECK(stats.at("covered_pixels").get<int>() > 500);
    CHECK(stats.at("overlap_mean").get<double>() >= 1);
    std::vector<std::string> passes;
    for (const auto& pass : stats.at("passes")) {
        passes.push_back(pass.at("name"));
        CHECK(pass.at("gpu_ms").get<double>() >= 0);
    }
    CHECK(passes == std::vector<std::string>{"triangle", "surfel_visibility", "surfel_attribute", "surfel_normalise",
                                             "read_back"});
}

TEST_CASE("software devices draw surfels tile by tile unless told otherwise") {
    const TemporaryFolder folder;
    write_small_model(folder / "a.splice");
    const auto backend = [&](const std::vector<std::string>& more) {
        std::vector<std::string> arguments{"a.splice", "-o", "a.png", "--device", "cpu", "--stats", "a.json"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        CHECK(capture(folder, arguments).exit_code == 0);
        return nlohmann::json::parse(read_text(folder / "a.json")).at("backend").get<std::string>();
    };
    CHECK(backend({}) == "tile");
    CHECK(backend({"--view", "visibility"}) == "raster");
    CHECK(backend({"--view", "visibility", "--backend", "tile"}) == "sprite");
    for (const char* named : {"sprite", "raster", "tile"})
        CHECK(backend({"--backend", named}) == named);
    CHECK(backend({"--points-below", "64", "--size", "32x32"}) == "point");
    const auto stats = nlohmann::json::parse(read_text(folder / "a.json"));
    CHECK(stats.at("drawn_by") == nlohmann::json{{"point", stats.at("surfels_drawn")}});
    CHECK(capture(folder, {"a.splice", "-o", "a.png", "--points-below", "65"}).exit_code == 2);
}

TEST_CASE("the frame's render graph is written in the form that the file's extension names") {
    const TemporaryFolder folder;
    write_small_model(folder / "a.splice");
    const auto graph_as = [&](const std::string& name) {
        const Outcome outcome = capture(folder, {"a.splice", "-o", "a.png", "--size", "64x64", "--backend", "sprite",
                                                 "--stats", "a.json", "--graph", name});
        CHECK(outcome.exit_code == 0);
        CHECK(outcome.err == "");
        return read_text(folder / name);
    };
    const std::string dot = graph_as("graph.dot");
    CHECK(dot.starts_with("digraph frame {"));
    CHECK(dot.find("label=\"surfel_attribute\"") != std::string::npos);
    const std::string mermaid = graph_as("graph.mmd");
    CHECK(mermaid.starts_with("flowchart LR"));
    CHECK(mermaid.find("[\"surfel_attribute\"]:::graphics") != std::string::npos);

    // The picture's own frame, not the one that counts overlaps for the statistics: one render pass and a copy.
    const auto json = nlohmann::json::parse(graph_as("graph.json"));
    REQUIRE(json.at("passes").size() == 5);
    CHECK(json.at("passes")[0].at("name") == "triangle");
    CHECK(json.at("plan").at("groups").size() == 2);
    CHECK(json.at("plan").at("groups")[0].at("passes") == nlohmann::json::parse("[0, 1, 2, 3]"));
    const auto& resources = json.at("resources");
    const auto resource = [&](const std::string& name) {
        return std::find_if(resources.begin(), resources.end(),
                            [&](const auto& one) { return one.at("name") == name; });
    };
    REQUIRE(resource("pixels") != resources.end());
    CHECK(resource("pixels")->at("residence") == "imported");
    REQUIRE(resource("picture") != resources.end());
    CHECK(resource("picture")->at("format") == "R8G8B8A8Unorm");
}

TEST_CASE("switches of the render graph change its plan and not a byte of the picture") {
    const TemporaryFolder folder;
    write_small_model(folder / "a.splice");
    const auto run_with = [&](const std::string& name, std::vector<std::string> switches) {
        std::vector<std::string> arguments{"a.splice",  "-o",     name + ".png", "--size",  "64x64",
                                           "--backend", "sprite", "--validate",  "--graph", name + ".json"};
        arguments.insert(arguments.end(), switches.begin(), switches.end());
        const Outcome outcome = capture(folder, arguments);
        CHECK(outcome.err == "");
        CHECK(outcome.exit_code == 0);
        return nlohmann::json::parse(read_text(folder / (name + ".json")));
    };
    const auto reference = run_with("reference", {});
    const std::string picture = read_text(folder / "reference.png");
    CHECK(!picture.empty());
    for (const std::string list :
         {"no-cull", "no-merge", "no-alias", "one-barrier-per-access", "random-order=7",
          "no-cull,no-merge,no-alias,one-barrier-per-access,random-order=18446744073709551615"}) {
        CAPTURE(list);
        const auto graph = run_with("switched", {"--graph-switch", list});
        CHECK(read_text(folder / "switched.png") == picture);
        const bool merges = list.find("no-merge") == std::string::npos;
        CHECK((graph.at("plan").at("groups") == reference.at("plan").at("groups")) == merges);
    }
    for (const std::string wrong : {"no-culling", "no-cull,", "random-order=", "random-order=-1"}) {
        const Outcome outcome = capture(folder, {"a.splice", "-o", "b.png", "--graph-switch", wrong});
        CHECK(outcome.exit_code == 2);
        CHECK_THAT(outcome.err, Catch::Contains("--graph-switch: expected some of no-cull, no-merge"));
    }
}

TEST_CASE("what each pass drew is counted when asked for") {
    const TemporaryFolder folder;
    write_small_model(folder / "a.splice");
    const Outcome outcome = capture(folder, {"a.splice", "-o", "a.png", "--size", "64x64", "--backend", "sprite",
                                             "--validate", "--stats", "a.json", "--pass-statistics"});
    CHECK(outcome.err == "");
    const auto passes = nlohmann::json::parse(read_text(folder / "a.json")).at("passes");
    REQUIRE(passes.size() == 5);
    CHECK(passes[0].at("name") == "triangle");
    if (passes[0].contains("vertex_invocations")) {  // where the device counts
        CHECK(passes[0].at("input_vertices") == 6);
        CHECK(passes[0].at("fragment_invocations").get<int>() > 100);
        CHECK(passes[2].at("fragment_invocations").get<int>() > 100);
        CHECK_FALSE(passes[4].contains("fragment_invocations"));  // a copy
    }
    CHECK(capture(folder, {"a.splice", "-o", "a.png", "--pass-statistics"}).exit_code == 2);
}

TEST_CASE("a mesh and a scene that names it make the same picture") {
    const TemporaryFolder folder;
    write_text(folder / "tetra.obj", "v 0 0 0\nv 2 0 0\nv 0 2 0\nv 0 0 2\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n");
    write_text(folder / "scene.json", R"({"models": [{"file": "tetra.obj"}], "render": {"size": [64, 64]}})");
    CHECK(capture(folder, {"tetra.obj", "-o", "mesh.png", "--size", "64x64", "--quiet"}).exit_code == 0);
    CHECK(capture(folder, {"scene.json", "-o", "scene.png", "--quiet"}).exit_code == 0);
    const Picture mesh = read_png(folder / "mesh.png"), scene = read_png(folder / "scene.png");
    CHECK(mesh.rgba == scene.rgba);
    CHECK(std::any_of(mesh.rgba.begin(), mesh.rgba.end(), [](std::uint8_t v) { return v != 255; }));
}

TEST_CASE("several models share a picture, as a scene that names them, but scenes are captured alone") {
    const TemporaryFolder folder;
    const std::string tetra = "f 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";
    write_text(folder / "a.obj", "v 0 0 0\nv 2 0 0\nv 0 2 0\nv 0 0 2\n" + tetra);
    write_text(folder / "b.obj", "v 3 0 0\nv 5 0 0\nv 3 2 0\nv 3 0 2\n" + tetra);
    write_text(folder / "scene.json",
               R"({"models": [{"file": "a.obj"}, {"file": "b.obj"}], "render": {"size": [64, 64], "show": "triangles",
                   "backend": "raster", "merge": 0}})");
    CHECK(capture(folder, {"a.obj", "b.obj", "-o", "both.png", "--size", "64x64", "--show", "triangles"}).exit_code ==
          0);
    CHECK(capture(folder, {"a.obj", "-o", "one.png", "--size", "64x64"}).exit_code == 0);
    CHECK(capture(folder, {"scene.json", "-o", "scene.png", "--stats", "stats.json"}).exit_code == 0);
    CHECK(read_png(folder / "both.png").rgba == read_png(folder / "scene.png").rgba);
    CHECK(read_png(folder / "both.png").rgba != read_png(folder / "one.png").rgba);
    const Outcome refused = capture(folder, {"a.obj", "scene.json", "-o", "none.png"});
    CHECK(refused.exit_code == 2);
    CHECK(refused.err.find("scene.json: a scene file is opened alone") != std::string::npos);
    const Outcome overwriting = capture(folder, {"a.obj", "b.obj", "-o", "b.obj"});
    CHECK(overwriting.exit_code == 2);
    CHECK(read_text(folder / "b.obj").starts_with("v 3"));
}

TEST_CASE("unit_box places a model by its bounding box, whatever its coordinates") {
    const TemporaryFolder folder;
    write_text(folder / "small.obj", "v 0 0 0\nv 2 0 0\nv 0 2 0\nv 0 0 2\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n");
    write_text(folder / "far.obj",
               "v 1000 500 0\nv 1200 500 0\nv 1000 700 0\nv 1000 500 200\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n");
    const std::string rest = R"(, "unit_box": true, "transform": {"scale": 2}}],
        "camera": {"eye": [2, 2, 5], "target": [0, 0, 0]}, "render": {"size": [64, 64]}})";
    write_text(folder / "small.json", R"({"models": [{"file": "small.obj")" + rest);
    write_text(folder / "far.json", R"({"models": [{"file": "far.obj")" + rest);
    CHECK(capture(folder, {"small.json", "-o", "small.png", "--quiet"}).exit_code == 0);
    CHECK(capture(folder, {"far.json", "-o", "far.png", "--quiet"}).exit_code == 0);
    CHECK(read_png(folder / "small.png").rgba == read_png(folder / "far.png").rgba);
}

TEST_CASE("an orbit writes numbered pictures and a record of each") {
    const TemporaryFolder folder;
    write_small_model(folder / "a.splice");
    const Outcome outcome = capture(folder, {"a.splice", "-o", "turn.png", "--orbit", "4", "--size", "48x48",
                                             "--two-sided", "--stats", "turn.json", "--quiet"});
    CHECK(outcome.exit_code == 0);
    CHECK(outcome.out + outcome.err == "");
    CHECK(files_in(folder.path()) == std::vector<std::string>{"a.splice", "turn-000.png", "turn-001.png",
                                                              "turn-002.png", "turn-003.png", "turn.json"});
    CHECK(read_png(folder / "turn-000.png").rgba != read_png(folder / "turn-001.png").rgba);
    const auto stats = nlohmann::json::parse(read_text(folder / "turn.json"));
    CHECK(stats.at("frames").size() == 4);
}

TEST_CASE("an explicit camera sees what it is pointed at") {
    const TemporaryFolder folder;
    write_small_model(folder / "a.splice");
    // Left of the middle surfels, right triangles: from behind their places are swapped.
    const std::vector<std::string> common{"--size",       "64x64", "--quiet",  "--two-sided",
                                          "--background", "black", "--target", "0,0,0"};
    for (const bool behind : {false, true}) {
        for (const bool orthographic : {false, true}) {
            CAPTURE(behind, orthographic);
            std::vector<std::string> arguments{"a.splice", "-o", "a.png", "--eye", behind ? "0,0,-2" : "0,0,2"};
            arguments.insert(arguments.end(), common.begin(), common.end());
            if (orthographic) arguments.push_back("--orthographic");
            REQUIRE(capture(folder, arguments).exit_code == 0);
            const Picture picture = read_png(folder / "a.png");
            const auto channel = [&](std::uint32_t x, int which) {
                return static_cast<int>(picture.rgba[4 * (32 * std::size_t{64} + x) + static_cast<std::size_t>(which)]);
            };
            CHECK(channel(behind ? 44 : 20, 0) > 100);
            CHECK(channel(behind ? 20 : 44, 1) > 100);
            CHECK(channel(behind ? 44 : 20, 1) < 30);
            CHECK(channel(2, 0) + channel(2, 1) == 0);
        }
    }
}

TEST_CASE("looking straight down or up needs no --up") {
    const TemporaryFolder folder;
    write_text(folder / "tetra.obj", "v 0 0 0\nv 2 0 0\nv 0 2 0\nv 0 0 2\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n");
    for (const auto& [eye, up] : {std::pair{"0.5,9,0.5", "0,0,-1"}, std::pair{"0.5,-9,0.5", "0,0,1"}}) {
        CAPTURE(eye);
        const std::vector<std::string> arguments{"tetra.obj", "--size", "32x32",    "--quiet",
                                                 "--eye",     eye,      "--target", "0.5,0,0.5"};
        std::vector<std::string> without = arguments, with = arguments;
        without.insert(without.end(), {"-o", "without.png"});
        with.insert(with.end(), {"-o", "with.png", "--up", up});
        REQUIRE(capture(folder, without).exit_code == 0);
        REQUIRE(capture(folder, with).exit_code == 0);
        CHECK(read_png(folder / "without.png").rgba == read_png(folder / "with.png").rgba);
    }
}

TEST_CASE("a transparent background is transparent in the file") {
    const TemporaryFolder folder;
    write_small_model(folder / "a.splice");
    REQUIRE(capture(folder, {"a.splice", "-o", "a.png", "--background", "transparent", "--size", "32x32"}).exit_code ==
            0);
    const Picture picture = read_png(folder / "a.png");
    CHECK(picture.rgba[3] == 0);
    CHECK(picture.rgba[4 * (16 * 32 + 16) + 3] == 255);
}

TEST_CASE("every view is a valid run of the program, validated") {
    const TemporaryFolder folder;
    write_small_model(folder / "a.splice");
    for (const char* view : {"shaded", "depth", "wireframe", "overlap"}) {
        CAPTURE(view);
        const Outcome outcome =
            capture(folder, {"a.splice", "-o", "a.png", "--view", view, "--validate", "--size", "64x64", "--quiet"});
        CHECK(outcome.exit_code == 0);
        CHECK(outcome.err == "");
    }
}

TEST_CASE("help, version and the list of devices need no input") {
    const TemporaryFolder folder;
    const Outcome help = capture(folder, {"--help"});
    CHECK(help.exit_code == 0);
    for (const char* part : {"--epsilon-scale", "DEGREES", "triangles-only", "Examples:", "Exit status"})
        CHECK(help.out.find(part) != std::string::npos);
    CHECK(capture(folder, {"--version"}).out.find("splice-capture ") == 0);
    const Outcome devices = capture(folder, {"--list-devices"});
    CHECK(devices.exit_code == 0);
    CHECK(devices.out.find("0: ") == 0);
}
