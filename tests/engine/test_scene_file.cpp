#include "engine/scene/scene_file.h"
#include "preprocess/model_format/error.h"

#include <catch2/catch.hpp>

#include <string>

using namespace splice;

namespace {

std::string complaint(const std::string& text) {
    try {
        parse_scene(text, "scene.json", "folder");
    } catch (const InputError& error) {
        return error.what();
    }
    return "accepted";
}

std::string with_model(const std::string& members) {
    return R"({"models": [{"file": "a.splice")" + (members.empty() ? "" : ", " + members) + "}]}";
}

std::string with(const std::string& members) {
    return R"({"models": [{"file": "a.splice"}], )" + members + "}";
}

}  // namespace

TEST_CASE("a scene is complained about with the path of the offending value") {
    const std::string big(200, 'x');
    const std::vector<std::pair<std::string, std::string>> table{
        {"", "scene.json: line 1, column 1: not valid JSON: unexpected end of input; expected '[', '{', or a literal"},
        {"{\n\"models\": [\n  }",
         "scene.json: line 3, column 3: not valid JSON: unexpected '}'; expected '[', '{', or a literal"},
        {"{\"a - b\": tru}",
         "scene.json: line 1, column 14: not valid JSON: invalid literal; last read: '\"a - b\": tru}'"},
        {"{\"models\":\n [{\"file\": \"a\", \"transform\": {\"scale\": 1e999}}]}",
         "scene.json: line 2, column 40: not valid JSON: the number 1e999 is out of range"},
        {"[]", "scene.json: /: expected an object, got an array of 0"},
        {"{}", "scene.json: /: member \"models\" is missing"},
        {R"({"models": []})", "scene.json: /models: expected an array of 1 or more, got an array of 0"},
        {R"({"models": {}})", "scene.json: /models: expected an array of 1 or more, got an object"},
        {R"({"models": [3]})", "scene.json: /models/0: expected an object, got 3"},
        {R"({"models": [{}]})",
         "scene.json: /models/0: expected an object with either \"file\" or \"shape\", got an object"},
        {with_model(R"("shape": {"kind": "cube"})"),
         "scene.json: /models/0: expected an object with either \"file\" or \"shape\", got an object"},
        {R"({"models": [{"file": 7}]})", "scene.json: /models/0/file: expected a string, got 7"},
        {R"({"models": [{"shape": {}}]})", "scene.json: /models/0/shape: member \"kind\" is missing"},
        {R"({"models": [{"shape": {"kind": "cube", "cells": "x"}}]})",
         "scene.json: /models/0/shape/cells: expected a number, got \"x\""},
        {with_model(R"("transform": {"scale": -1})"),
         "scene.json: /models/0/transform/scale: expected a positive number from 1e-30 to 1e30, got -1"},
        {with_model(R"("transform": {"scale": 0})"),
         "scene.json: /models/0/transform/scale: expected a positive number from 1e-30 to 1e30, got 0"},
        {with_model(R"("transform": {"scale": 1e38})"),
         "scene.json: /models/0/transform/scale: expected a positive number from 1e-30 to 1e30, got 1e+38"},
        {with_model(R"("transform": {"scale": [1, 2, 3]})"),
         "scene.json: /models/0/transform/scale: expected a positive number from 1e-30 to 1e30, got an array of 3"},
        {with_model(R"("transform": {"translation": [1, 2]})"),
         "scene.json: /models/0/transform/translation: expected three numbers, got an array of 2"},
        {with_model(R"("transform": {"translation": [1, 2, "x"]})"),
         "scene.json: /models/0/transform/translation/2: expected a number, got \"x\""},
        {with_model(R"("transform": {"rotation": {"axis": [0, 0, 0], "angle": 1}})"),
         "scene.json: /models/0/transform/rotation/axis: expected a direction other than zero, got an array of 3"},
        {with_model(R"("transform": {"rotation": {"axis": [0, 1, 0]}})"),
         "scene.json: /models/0/transform/rotation: member \"angle\" is missing"},
        {with_model(R"("colour": 1)"),
         "scene.json: /models/0/colour: unknown member, expected one of file, shape, transform, unit_box, "
         "representation, "
         "selection, triangle_share, sampling, max_spacing"},
        {with(R"("lighting": {"highlight": "shiny"})"),
         "scene.json: /lighting/highlight: expected one of \"blinn-phong\", \"phong\", got \"shiny\""},
        {with(R"("lighting": {"rim": -1})"),
         "scene.json: /lighting/rim: expected a number that is not negative, got -1"},
        {with(R"("lighting": {"rim_exponent": 0})"),
         "scene.json: /lighting/rim_exponent: expected a number from 1 to 1000000, got 0"},
        {with(R"("render": {"shading": "cel"})"),
         "scene.json: /render/shading: expected one of \"surfel\", \"deferred\", got \"cel\""},
        {with(R"("render": {"antialias": 0})"),
         "scene.json: /render/antialias: expected a whole number from 1 to 8, got 0"},
        {with(R"("render": {"antialias": 9})"),
         "scene.json: /render/antialias: expected a whole number from 1 to 8, got 9"},
        {with(R"("render": {"tau": -1})"), "scene.json: /render/tau: expected a number from 0 to 1000, got -1"},
        {with(R"("render": {"show": "points"})"),
         "scene.json: /render/show: expected one of \"hybrid\", \"triangles\", \"surfels\", got \"points\""},
        {with(R"("render": {"backend": "fast"})"),
         "scene.json: /render/backend: expected one of \"auto\", \"sprite\", \"raster\", \"tile\", \"point\", got "
         "\"fast\""},
        {with(R"("render": {"merge": 65})"), "scene.json: /render/merge: expected a number from 0 to 64, got 65"},
        {with(R"("render": {"levels_from": {"azimuth": 3}})"),
         "scene.json: /render/levels_from: expected a camera with eye and target, got an object"},
        {with(R"("comparison": {})"), "scene.json: /comparison: member \"kind\" is missing"},
        {with(R"("comparison": {"kind": "blink"})"),
         "scene.json: /comparison/kind: expected one of \"off\", \"side-by-side\", \"wipe\", got \"blink\""},
        {with(R"("comparison": {"kind": "wipe", "wipe": 2})"),
         "scene.json: /comparison/wipe: expected a number from 0 to 1, got 2"},
        {with(R"("comparison": {"kind": "wipe", "right": {"size": [1, 1]}})"),
         "scene.json: /comparison/right/size: unknown member, expected one of view, show, backend, sides, "
         "epsilon_scale, prefilter, antialias, shading, merge, tau, kernel"},
        {with(R"("comparison": {"kind": "wipe", "right": {"tau": -1}})"),
         "scene.json: /comparison/right/tau: expected a number from 0 to 1000, got -1"},
        {with_model(R"("selection": "random")"),
         "scene.json: /models/0/selection: expected one of \"geometric\", \"thesis\", got \"random\""},
        {with_model(R"("sampling": 0)"),
         "scene.json: /models/0/sampling: expected \"adaptive\" or a number from 0.1 to 64, got 0"},
        {with_model(R"("sampling": "dense")"),
         "scene.json: /models/0/sampling: expected \"adaptive\" or a number from 0.1 to 64, got \"dense\""},
        {with(R"("render": {"kernel": "box"})"),
         "scene.json: /render/kernel: expected a kernel, such as \"gaussian:0.5\", \"confetti:6,1.5,3\", "
         "\"constant\" or \"disk\", got \"box\""},
        {with_model(R"("unit_box": 1)"), "scene.json: /models/0/unit_box: expected true or false, got 1"},
        {with_model(R"("representation": "points")"),
         "scene.json: /models/0/representation: expected one of \"hybrid\", \"triangles\", \"surfels\", got "
         "\"points\""},
        {with_model(R"("triangle_share": 1.5)"),
         "scene.json: /models/0/triangle_share: expected a number from 0 to 1, got 1.5"},
        {with_model(R"("triangle_share": 0.5, "representation": "triangles")"),
         "scene.json: /models/0/triangle_share: expected \"representation\": \"hybrid\" beside it, got 0.5"},
        {with(R"("camera": {"eye": [0, 0, 1]})"), "scene.json: /camera: member \"target\" is missing"},
        {with(R"("camera": {"eye": [0, 0, 0], "target": [0, 0, 0]})"),
         "scene.json: /camera: expected eye and target apart, and up in another direction, got an object"},
        {with(R"("camera": {"eye": [0, 0, 1], "target": [0, 0, 0], "azimuth": 3})"),
         "scene.json: /camera/azimuth: expected nothing beside \"eye\", got 3"},
        {with(R"("camera": {"target": [0, 0, 0]})"),
         "scene.json: /camera/target: expected \"eye\" beside it, got an array of 3"},
        {with(R"("camera": {"fov": 180})"),
         "scene.json: /camera/fov: expected an angle from 1 to 170 degrees, got 180"},
        {with(R"("camera": {"eye": [0, 0, 1], "target": [0, 0, 0], "orthographic": true})"),
         "scene.json: /camera: member \"height\" is missing"},
        {with(R"("camera": {"elevation": 91})"),
         "scene.json: /camera/elevation: expected an angle from -90 to 90 degrees, got 91"},
        {with(R"("lighting": {"ambient": -1})"),
         "scene.json: /lighting/ambient: expected a number that is not negative, got -1"},
        {with(R"("lighting": {"lights": [{"type": "spot"}]})"),
         "scene.json: /lighting/lights/0/type: expected one of \"directional\", \"point\", got \"spot\""},
        {with(R"("lighting": {"lights": [{"type": "directional"}]})"),
         "scene.json: /lighting/lights/0: member \"direction\" is missing"},
        {with(R"("lighting": {"lights": [{"type": "point", "position": [0, 0, 0]}]})"),
         "scene.json: /lighting/lights/0: member \"range\" is missing"},
        {with(R"("lighting": {"lights": [{"type": "point", "position": [0, 0, 0], "range": 0}]})"),
         "scene.json: /lighting/lights/0/range: expected a positive number from 1e-30 to 1e30, got 0"},
        {with(R"("lighting": {"lights": [{"type": "directional", "direction": [0, 0, 1], "colour": "pink"}]})"),
         "scene.json: /lighting/lights/0/colour: expected a colour like \"#ff8000\", got \"pink\""},
        {with(R"("background": 3)"),
         "scene.json: /background: expected a colour like \"#ff8000\", or \"transparent\", got 3"},
        {with(R"("background": "#12345")"),
         "scene.json: /background: expected a colour like \"#ff8000\", or \"transparent\", got \"#12345\""},
        {with(R"("render": {"size": [0, 5]})"),
         "scene.json: /render/size/0: expected a whole number from 1 to 65536, got 0"},
        {with(R"("render": {"size": [5, 5.5]})"),
         "scene.json: /render/size/1: expected a whole number from 1 to 65536, got 5.5"},
        {with(R"("render": {"size": [5]})"), "scene.json: /render/size: expected an array of 2, got an array of 1"},
        {with(R"("render": {"view": "nice"})"),
         "scene.json: /render/view: expected the name of a view, such as \"shaded\", got \"nice\""},
        {with(R"("render": {"epsilon_scale": -0.5})"),
         "scene.json: /render/epsilon_scale: expected a number from 0 to 100, got -0.5"},
        {with(R"("render": {"sides": "both"})"),
         "scene.json: /render/sides: expected one of \"as-baked\", \"one-sided\", \"two-sided\", got \"both\""},
        {with("\"a/b~\": 1"),
         "scene.json: /a~1b~0: unknown member, expected one of models, camera, lighting, background, render, "
         "comparison, bookmarks"},
        {R"({"models": [{"file": ")" + big + R"("}], "background": ")" + big + "\"}",
         "scene.json: /background: expected a colour like \"#ff8000\", or \"transparent\", got \"" +
             std::string(59, 'x') + "..."},
    };
    for (const auto& [text, expected] : table)
        CHECK(complaint(text) == expected);
}

TEST_CASE("a scene that says everything is read as it says") {
    const SceneDescription scene = parse_scene(R"({
        "models": [
            {"file": "a.splice", "transform": {"scale": 2, "rotation": {"axis": [0, 0, 2], "angle": 90},
                                               "translation": [1, 2, 3]}},
            {"shape": {"kind": "torus-knot", "p": 3}, "unit_box": true, "representation": "surfels",
             "max_spacing": 0.5, "selection": "thesis", "sampling": 2}],
        "camera": {"eye": [0, 0, 5], "target": [0, 0, 0], "up": [1, 0, 0], "fov": 30, "orthographic": true, "height": 4},
        "lighting": {"ambient": [0.1, 0.2, 0.3], "specular": 0.5, "shininess": 8, "highlight": "phong",
                     "rim": 0.25, "rim_exponent": 5, "lights": [
            {"type": "point", "position": [1, 1, 1], "range": 2, "colour": "#ffffff", "intensity": 3},
            {"type": "directional", "direction": [0, -1, 0], "space": "camera", "colour": 0.5}]},
        "background": "#f80",
        "render": {"size": [320, 200], "view": "overlap", "sides": "two-sided", "epsilon_scale": 1.5, "prefilter": false,
                   "shading": "deferred", "antialias": 3, "tau": 1.5, "kernel": "gaussian:0.5",
                   "show": "surfels", "backend": "raster", "merge": 0},
        "comparison": {"kind": "side-by-side", "right": {"show": "triangles", "tau": 0}}
    })",
                                               "scene.json", "folder");
    REQUIRE(scene.models.size() == 2);
    CHECK(std::get<std::filesystem::path>(scene.models[0].source) == "folder/a.splice");
    CHECK(scene.models[0].transform.scale == 2);
    const glm::dvec3 turned = scene.models[0].transform.rotation * glm::dvec3(1, 0, 0);
    CHECK(glm::distance(turned, glm::dvec3(0, 1, 0)) < 1e-12);
    CHECK(scene.models[0].transform.translation == glm::dvec3(1, 2, 3));
    const auto& shape = std::get<ShapeDescription>(scene.models[1].source);
    CHECK(shape.kind == "torus-knot");
    CHECK(shape.parameters == std::map<std::string, double>{{"p", 3}});
    CHECK(scene.models[1].unit_box);
    CHECK(scene.models[1].representation == SceneRepresentation::kSurfels);
    CHECK(scene.models[1].max_spacing == 0.5);
    CHECK(scene.models[1].bake_members ==
          std::vector<std::string>{"representation", "selection", "sampling", "max_spacing"});
    CHECK(scene.models[1].selection == SceneSelection::kThesis);
    CHECK(scene.models[1].sampling == 2);
    REQUIRE(scene.camera);
    CHECK(scene.camera->orthographic);
    CHECK(scene.camera->orthographic_height == 4);
    CHECK(scene.camera->up == glm::dvec3(1, 0, 0));
    REQUIRE(scene.lighting.lights.size() == 2);
    CHECK(scene.lighting.lights[0].colour == glm::dvec3(3));
    CHECK(scene.lighting.lights[1].space == LightSpace::kCamera);
    CHECK(scene.lighting.ambient == glm::dvec3(0.1, 0.2, 0.3));
    CHECK(scene.lighting.highlight == HighlightModel::kPhong);
    CHECK(scene.lighting.rim == 0.25);
    CHECK(scene.lighting.rim_exponent == 5);
    CHECK(scene.background.colour.g == Approx(0x88 / 255.0));
    CHECK(scene.width == 320);
    CHECK(scene.height == 200);
    CHECK(scene.look.view == View::kOverlap);
    CHECK(scene.look.sides == Sides::kTwoSided);
    CHECK(scene.look.epsilon_scale == 1.5);
    CHECK_FALSE(scene.look.prefilter);
    CHECK(scene.look.shading == Shading::kDeferred);
    CHECK(scene.look.antialias == 3);
    CHECK(scene.look.tau == 1.5);
    CHECK(scene.look.shown == Shown::kSurfels);
    CHECK(scene.look.backend == Backend::kRaster);
    CHECK(scene.look.merge_px == 0);
    CHECK(scene.comparison.kind == Comparison::kSideBySide);
    CHECK(scene.comparison.right.shown == Shown::kTriangles);
    CHECK(scene.comparison.right.tau == 0);
    CHECK(scene.comparison.right.view == View::kOverlap);  // what it does not say is the left one's
    CHECK(scene.look.kernel == parse_kernel("gaussian:0.5"));
}

TEST_CASE("the scene format's example in the documentation is valid") {
    const SceneDescription scene = parse_scene(R"({
      "models": [
        {"file": "bunny.splice", "transform": {"scale": 2, "translation": [0, 1, 0]}},
        {"shape": {"kind": "torus-knot", "p": 2, "q": 3}, "unit_box": true, "representation": "surfels"}
      ],
      "camera": {"azimuth": 30, "elevation": 20},
      "lighting": {"ambient": 0.2, "lights": [{"type": "directional", "direction": [0, -1, -1]}]},
      "background": "#d8dee8",
      "render": {"size": [768, 512], "view": "shaded"}
    })",
                                               "scene.json", "");
    CHECK(scene.models.size() == 2);
    CHECK_FALSE(scene.camera);
}
