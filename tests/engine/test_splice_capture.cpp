// splice-capture as a user meets it: pictures, options, bad input, exit codes.
#include "engine/capture/png_file.h"
#include "tests/cli/spawn.h"
#include "tests/engine/handmade_model.h"
#include "tests/support/test_files.h"

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iterator>

using namespace splice;
using namespace splice::test;

namespace {

Outcome capture(const TemporaryFolder& folder, const std::vector<std::string>& arguments) {
    return run({.program = program("splice-capture"), .arguments = arguments, .folder = folder.path()});
}

std::string read_text(const std::filesystem::path& path) {
    std::ifstream file(path);
    return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

void write_text(const std::filesystem::path& path, const std::string& text) {
    std::ofstream(path) << text;
}

// A red sheet of surfels beside a green quad of triangles.
void write_small_model(const std::filesystem::path& path) {
    HandmadeModel model;
    model.add_surfels(sheet({-0.5f, -0.5f, 0}, {0.5f, 0, 0}, {0, 1, 0}, 8, kRed));
    model.add_triangles(quad({0, -0.5f, 0}, {0.5f, 0, 0}, {0, 1, 0}, kGreen));
    write_model(view_of(model.model()), path);
}

std::vector<std::string> files_in(const std::filesystem::path& folder) {
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(folder))
        names.push_back(entry.path().filename());
    std::sort(names.begin(), names.end());
    return names;
}

}  // namespace

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
    CHECK(stats({"scene.json"})["cut"]["tau"] == 3);
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

TEST_CASE("wrong usage is one line and exit code 2") {
    const TemporaryFolder folder;
    write_small_model(folder / "a.splice");
    const std::vector<std::pair<std::vector<std::string>, std::string>> table{
        {{}, "INPUT is missing"},
        {{"a.splice"}, "-o OUT.png is missing"},
        {{"a.splice", "-o", "b.png", "--no-such-option"}, "--no-such-option"},
        {{"a.splice", "b.splice", "-o", "b.png"}, "b.splice"},
        {{"a.splice", "-o", "b.png", "--size", "512"},
         "--size: expected WIDTHxHEIGHT in pixels like 512x512, got \"512\""},
        {{"a.splice", "-o", "b.png", "--size", "0x5"}, "--size"},
        {{"a.splice", "-o", "b.png", "--size", "-4x5"}, "--size"},
        {{"a.splice", "-o", "b.png", "--size", "99999x99999"}, "a picture of 99999x99999 pixels"},
        {{"a.splice", "-o", "b.png", "--eye", "1,2", "--target", "0,0,0"}, "--eye: expected three numbers"},
        {{"a.splice", "-o", "b.png", "--eye", "1,2,x", "--target", "0,0,0"}, "--eye: expected three numbers"},
        {{"a.splice", "-o", "b.png", "--eye", "1,2,3,4", "--target", "0,0,0"}, "--eye: expected three numbers"},
        {{"a.splice", "-o", "b.png", "--eye", "1,2,nan", "--target", "0,0,0"}, "--eye: expected three numbers"},
        {{"a.splice", "-o", "b.png", "--eye", "1,2,3"}, "--eye and --target are given together"},
        {{"a.splice", "-o", "b.png", "--eye", "0,0,0", "--target", "0,0,0"}, "do not define a view"},
        {{"a.splice", "-o", "b.png", "--up", "0,0,1"}, "--up needs --eye"},
        {{"a.splice", "-o", "b.png", "--eye", "0,0,1", "--target", "0,0,0", "--zoom", "2"}, "exclude --azimuth"},
        {{"a.splice", "-o", "b.png", "--fov", "180"}, "--fov: expected a number from 1 to 170 degrees, got \"180\""},
        {{"a.splice", "-o", "b.png", "--fov", "wide"}, "--fov"},
        {{"a.splice", "-o", "b.png", "--elevation", "91"}, "--elevation"},
        {{"a.splice", "-o", "b.png", "--zoom", "0"}, "--zoom"},
        {{"a.splice", "-o", "b.png", "--orbit", "2.5"}, "--orbit: expected a whole number of frames"},
        {{"a.splice", "-o", "b.png", "--view", "pretty"}, "--view: expected one of shaded, depth"},
        {{"a.splice", "-o", "b.png", "--background", "#12"}, "--background: expected transparent"},
        {{"a.splice", "-o", "b.png", "--prefilter", "maybe"}, "--prefilter: expected on or off"},
        {{"a.splice", "-o", "b.png", "--epsilon-scale", "-1"}, "--epsilon-scale: expected a number from 0 to 100"},
        {{"a.splice", "-o", "b.png", "--one-sided", "--two-sided"}, "exclude each other"},
        {{"a.splice", "-o", "b.png", "--graph", "b.svg"},
         "--graph: expected a file that ends in .dot, .mmd or .json, got \"b.svg\""},
        {{"a.splice", "-o", "b.png", "--device", "banana"}, "banana"},
        {{"a.splice", "-o", "b.jpg"}, "-o b.jpg: pictures are PNG"},
        {{"a.splice", "-o", "b.TIFF"}, "pictures are PNG"},
        {{"a.splice", "-o", "b.png", "--orthographic", "--fov", "30"}, "--orthographic excludes --fov"},
    };
    for (const auto& [arguments, expected] : table) {
        const Outcome outcome = capture(folder, arguments);
        CAPTURE(arguments, outcome.err);
        CHECK(outcome.exit_code == 2);
        CHECK(line_count(outcome.err) == 1);
        CHECK(outcome.err.find("splice-capture: ") == 0);
        CHECK(outcome.err.find(expected) != std::string::npos);
        CHECK(files_in(folder.path()) == std::vector<std::string>{"a.splice"});
    }
}

TEST_CASE("input that cannot be used is one line and exit code 1, and leaves no picture") {
    const TemporaryFolder folder;
    write_small_model(folder / "a.splice");
    std::string bytes = read_text(folder / "a.splice");
    write_text(folder / "cut.splice", bytes.substr(0, bytes.size() / 2));
    bytes[bytes.size() - 5] = static_cast<char>(bytes[bytes.size() - 5] ^ 0x55);
    write_text(folder / "flipped.splice", bytes);
    write_text(folder / "empty.json", "");
    write_text(folder / "wrong.json", R"({"models": [{"file": "a.splice", "transform": {"scale": -1}}]})");
    write_text(folder / "missing.json", R"({"models": [{"file": "gone.splice"}]})");
    write_text(folder / "baked.json", R"({"models": [{"file": "a.splice", "representation": "surfels"}]})");
    write_text(folder / "loop.json", R"({"models": [{"file": "loop.json"}]})");
    write_text(folder / "shape.json", R"({"models": [{"shape": {"kind": "blob"}}]})");
    write_text(folder / "cells.json", R"({"models": [{"shape": {"kind": "cube", "cells": 0.5}}]})");
    write_text(folder / "knot.json", R"({"models": [{"shape": {"kind": "torus-knot", "p": 4, "q": 2}}]})");
    write_text(folder / "extra.json", R"({"models": [{"shape": {"kind": "cube", "sides": 3}}]})");
    write_text(folder / "nothing.obj", "# no faces\n");
    std::filesystem::create_directory(folder / "folder");
    const std::vector<std::string> before = files_in(folder.path());
    const std::vector<std::pair<std::vector<std::string>, std::string>> table{
        {{"gone.splice", "-o", "b.png"}, "gone.splice"},
        {{"folder", "-o", "b.png"}, "folder"},
        {{"cut.splice", "-o", "b.png"}, "cut.splice"},
        {{"flipped.splice", "-o", "b.png"}, "flipped.splice"},
        {{"empty.json", "-o", "b.png"}, "empty.json: line 1, column 1: not valid JSON"},
        {{"wrong.json", "-o", "b.png"},
         "wrong.json: /models/0/transform/scale: expected a positive number from 1e-30 to 1e30, got -1"},
        {{"missing.json", "-o", "b.png"}, "missing.json: /models/0/file: cannot read gone.splice: No such file"},
        {{"baked.json", "-o", "b.png"},
         "baked.json: /models/0/representation: expected a mesh or a shape beside it, got a model file"},
        {{"loop.json", "-o", "b.png"}, "loop.json: a scene file where a model or a mesh is expected"},
        {{"shape.json", "-o", "b.png"}, "shape.json: /models/0/shape/kind: expected one of cube, "},
        {{"cells.json", "-o", "b.png"},
         "cells.json: /models/0/shape/cells: expected a whole number from 1 to 1000, got 0.5"},
        {{"knot.json", "-o", "b.png"}, "knot.json: /models/0/shape: expected p and q without a common divisor"},
        {{"extra.json", "-o", "b.png"},
         "extra.json: /models/0/shape/sides: unknown member, expected one of kind, cells"},
        {{"nothing.obj", "-o", "b.png"}, "nothing.obj"},
        {{"a.splice", "-o", "no/such/folder/b.png"}, "no/such/folder"},
        {{"a.splice", "-o", "folder"}, "folder"},
        {{"a.splice", "-o", "b.png", "--device", "57"}, "57"},
    };
    for (const auto& [arguments, expected] : table) {
        const Outcome outcome = capture(folder, arguments);
        CAPTURE(arguments, outcome.err);
        CHECK(outcome.exit_code == 1);
        CHECK(line_count(outcome.err) == 1);
        CHECK(outcome.err.find("splice-capture: ") == 0);
        CHECK(outcome.err.find(expected) != std::string::npos);
        CHECK(files_in(folder.path()) == before);
    }
}

TEST_CASE("an output is never written over a texture that a mesh names") {
    const TemporaryFolder folder;
    write_text(folder / "quad.obj",
               "mtllib quad.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nusemtl paint\nf 1/1 2/2 3/3\n");
    write_text(folder / "quad.mtl", "newmtl paint\nmap_Kd paint.png\n");
    write_text(folder / "paint.png", "P6\n1 1\n255\nabc");
    write_text(folder / "scene.json", R"({"models": [{"file": "quad.obj"}]})");
    const std::vector<std::string> before = files_in(folder.path());
    const std::string texture = read_text(folder / "paint.png");
    for (const std::vector<std::string>& arguments :
         std::vector<std::vector<std::string>>{{"quad.obj", "-o", "paint.png"},
                                               {"scene.json", "-o", "./paint.png"},
                                               {"quad.obj", "-o", "z.png", "--stats", "quad.mtl"}}) {
        const Outcome outcome = capture(folder, arguments);
        CAPTURE(arguments, outcome.err);
        CHECK(outcome.exit_code == 2);
        CHECK(outcome.err.find("would overwrite a mesh's material or texture") != std::string::npos);
        CHECK(files_in(folder.path()) == before);
        CHECK(read_text(folder / "paint.png") == texture);
    }
}

TEST_CASE("an output is never written over an input or another output") {
    const TemporaryFolder folder;
    write_small_model(folder / "a.splice");
    write_small_model(folder / "turn-001.png");
    write_text(folder / "scene.json", R"({"models": [{"shape": {"kind": "cube"}}, {"file": "a.splice"}]})");
    std::filesystem::create_symlink("a.splice", folder / "link.png");
    const std::vector<std::string> before = files_in(folder.path());
    const std::string model = read_text(folder / "a.splice"), scene = read_text(folder / "scene.json");
    for (const std::vector<std::string>& arguments : std::vector<std::vector<std::string>>{
             {"a.splice", "-o", "a.splice"},
             {"a.splice", "-o", "./a.splice"},
             {"a.splice", "-o", (folder / "a.splice").string()},
             {"a.splice", "-o", "link.png"},
             {"a.splice", "-o", "z.png", "--stats", "a.splice"},
             {"a.splice", "-o", "z.png", "--stats", "./z.png"},
             {"a.splice", "-o", "z.png", "--graph", "z.json", "--stats", "./z.json"},
             {"scene.json", "-o", "z.png", "--stats", "scene.json"},
             {"scene.json", "-o", "z.png", "--graph", "./scene.json"},
             {"scene.json", "-o", "a.splice"},
             {"turn-001.png", "-o", "turn.png", "--orbit", "2"},
             {"a.splice", "-o", "turn.png", "--orbit", "2", "--stats", "turn-000.png"}}) {
        const Outcome outcome = capture(folder, arguments);
        CAPTURE(arguments, outcome.err);
        CHECK(outcome.exit_code == 2);
        CHECK(line_count(outcome.err) == 1);
        CHECK(outcome.err.find("would overwrite") != std::string::npos);
        CHECK(files_in(folder.path()) == before);
        CHECK(read_text(folder / "a.splice") == model);
        CHECK(read_text(folder / "scene.json") == scene);
    }
    // An orbit does not write the name it is given.
    CHECK(capture(folder, {"a.splice", "-o", "a.splice", "--orbit", "1", "--size", "8x8", "--quiet"}).exit_code == 0);
    CHECK(read_text(folder / "a.splice") == model);
}

TEST_CASE("a picture that is already there survives a failed run") {
    const TemporaryFolder folder;
    write_text(folder / "a.png", "precious");
    CHECK(capture(folder, {"gone.splice", "-o", "a.png"}).exit_code == 1);
    CHECK(read_text(folder / "a.png") == "precious");
}

TEST_CASE("help that does not fit behind standard output is a failure") {
    const TemporaryFolder folder;
    for (const char* option : {"--help", "--list-devices"}) {
        const Outcome outcome =
            run({.program = program("splice-capture"), .arguments = {option}, .folder = folder.path(), .in_child = [] {
                     if (!std::freopen("/dev/full", "w", stdout)) std::abort();
                 }});
        CAPTURE(option, outcome.err);
        CHECK(outcome.exit_code == 1);
        CHECK(line_count(outcome.err) == 1);
        CHECK(outcome.err.find("splice-capture: cannot write to standard output") == 0);
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

TEST_CASE("without a Vulkan driver the message says what to install") {
    const TemporaryFolder folder;
    write_small_model(folder / "a.splice");
    const Outcome outcome = run({.program = program("splice-capture"),
                                 .arguments = {"a.splice", "-o", "a.png"},
                                 .folder = folder.path(),
                                 .in_child = [] { setenv("VK_ICD_FILENAMES", "/nonexistent.json", 1); }});
    CHECK(outcome.exit_code == 1);
    CHECK(line_count(outcome.err) == 1);
    CHECK(outcome.err.find("mesa-vulkan-drivers") != std::string::npos);
}
