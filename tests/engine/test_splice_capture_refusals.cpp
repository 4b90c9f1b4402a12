// splice-capture where it cannot do what it is asked: bad usage, bad input, outputs that would overwrite, exit codes.
#include "tests/engine/capture_program.h"

#include <catch2/catch.hpp>

#include <cstdio>
#include <cstdlib>

using namespace splice;
using namespace splice::test;

TEST_CASE("wrong usage is one line and exit code 2") {
    const TemporaryFolder folder;
    write_small_model(folder / "a.splice");
    const std::vector<std::pair<std::vector<std::string>, std::string>> table{
        {{}, "INPUT is missing"},
        {{"a.splice"}, "-o OUT.png is missing"},
        {{"a.splice", "-o", "b.png", "--no-such-option"}, "--no-such-option"},
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
    write_text(folder / "line.obj", "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n");  // read well, refused by repair
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
        {{"line.obj", "-o", "b.png"}, "line.obj"},
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

TEST_CASE("without a Vulkan driver the message says what to install") {
    const TemporaryFolder folder;
    write_small_model(folder / "a.splice");
    const Outcome outcome = run({.program = program("splice-capture"),
                                 .arguments = {"a.splice", "-o", "a.png"},
                                 .folder = folder.path(),
                                 .environment = {"VK_ICD_FILENAMES=/nonexistent.json"}});
    CHECK(outcome.exit_code == 1);
    CHECK(line_count(outcome.err) == 1);
    CHECK(outcome.err.find("mesa-vulkan-drivers") != std::string::npos);
}
