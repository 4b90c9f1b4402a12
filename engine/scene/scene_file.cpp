#include "engine/scene/scene_file.h"

#include "engine/scene/json_value.h"
#include "preprocess/mesh/text_scanner.h"
#include "preprocess/model_format/error.h"

#include <glm/gtc/matrix_transform.hpp>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cctype>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <fstream>
#include <iterator>
#include <utility>

namespace splice {

namespace {

constexpr double kLargest = 1e30;  // lengths beyond overflow single precision once squared

// A colour in a scene file: a name or #rrggbb (sRGB-encoded), or three linear numbers where light is meant.
glm::dvec3 linear_colour(const JsonValue& value) {
    if (value.is_string()) {
        const auto colour = parse_colour(value.string());
        if (!colour) value.fail("a colour like \"#ff8000\"");
        return linear_light(*colour);
    }
    const auto channel = [](const JsonValue& one) { return one.number(0, kLargest, "a number that is not negative"); };
    if (value.is_number()) return glm::dvec3(channel(value));
    if (value.is_array() && value.json().size() == 3)
        return {channel(value.element(0)), channel(value.element(1)), channel(value.element(2))};
    value.fail("a colour: \"#rrggbb\", a number or three numbers");
}

glm::dvec3 direction(const JsonValue& value) {
    const glm::dvec3 v = value.vector();
    if (!(glm::length(v) > 0) || glm::length(v) > kLargest) value.fail("a direction other than zero");
    return v;
}

template <typename Value, std::size_t N>
Value choice(const JsonValue& value, const Names<Value, N>& names) {
    if (const auto known = find_named(names, value.is_string() ? value.string() : "")) return *known;
    value.fail("one of " + listed(names, "\""));
}

Transform read_transform(const JsonValue& value) {
    value.expect_members({"scale", "rotation", "translation"});
    Transform transform;
    if (const auto scale = value.member("scale"))
        transform.scale = scale->number(1 / kLargest, kLargest, "a positive number from 1e-30 to 1e30");
    if (const auto rotation = value.member("rotation")) {
        rotation->expect_members({"axis", "angle"});
        const glm::dvec3 axis = glm::normalize(direction(rotation->required("axis")));
        const double angle = rotation->required("angle").any_number();
        transform.rotation = glm::dmat3(glm::rotate(glm::dmat4(1.0), glm::radians(angle), axis));
    }
    if (const auto translation = value.member("translation")) transform.translation = translation->vector();
    return transform;
}

ShapeDescription read_shape(const JsonValue& value) {
    ShapeDescription shape;
    if (!value.json().is_object()) value.fail("an object");
    shape.kind = value.required("kind").string();
    for (const auto& [name, parameter] : value.json().items()) {
        if (name == "kind") continue;
        shape.parameters[name] = value.required(name).any_number();
    }
    return shape;
}

std::optional<double> read_sampling(const JsonValue& value) {
    if (value.is_string() && value.string() == "adaptive") return std::nullopt;
    if (!value.is_number()) value.fail("\"adaptive\" or a number from 0.1 to 64");
    return value.number(0.1, 64, "\"adaptive\" or a number from 0.1 to 64");
}

SceneModel read_model(const JsonValue& value, const std::filesystem::path& folder) {
    value.expect_members({"file", "shape", "transform", "unit_box", "representation", "selection", "triangle_share",
                          "sampling", "max_spacing"});
    SceneModel model;
    const auto file = value.member("file"), shape = value.member("shape");
    if (file.has_value() == shape.has_value()) value.fail("an object with either \"file\" or \"shape\"");
    if (file) {
        const std::string name = file->string();
        if (name.empty()) file->fail("the name of a model or mesh file");
        model.source = folder / name;
    } else {
        model.source = read_shape(*shape);
    }
    if (const auto transform = value.member("transform")) model.transform = read_transform(*transform);
    if (const auto unit_box = value.member("unit_box")) model.unit_box = unit_box->boolean();
    if (const auto representation = value.member("representation"))
        model.representation =
            choice(*representation, Names<SceneRepresentation, 3>{{{SceneRepresentation::kHybrid, "hybrid"},
                                                                   {SceneRepresentation::kTriangles, "triangles"},
                                                                   {SceneRepresentation::kSurfels, "surfels"}}});
    if (const auto selection = value.member("selection"))
        model.selection = choice(*selection, Names<SceneSelection, 2>{{{SceneSelection::kGeometric, "geometric"},
                                                                       {SceneSelection::kThesis, "thesis"}}});
    if (const auto sampling = value.member("sampling")) model.sampling = read_sampling(*sampling);
    if (const auto share = value.member("triangle_share"))
        model.triangle_share = share->number(0, 1, "a number from 0 to 1");
    if (const auto spacing = value.member("max_spacing"))
        model.max_spacing = spacing->number(1e-4, 1, "a number from 0.0001 to 1");
    if (model.triangle_share && model.representation != SceneRepresentation::kHybrid)
        value.member("triangle_share")->fail("\"representation\": \"hybrid\" beside it");
    for (const char* name : {"representation", "selection", "triangle_share", "sampling", "max_spacing"})
        if (value.member(name)) model.bake_members.emplace_back(name);
    return model;
}

void read_camera(const JsonValue& value, SceneDescription& scene) {
    value.expect_members({"eye", "target", "up", "fov", "orthographic", "height", "azimuth", "elevation", "zoom"});
    double fov = 40;
    if (const auto given = value.member("fov")) fov = given->number(1, 170, "an angle from 1 to 170 degrees");
    const auto orthographic_member = value.member("orthographic");
    const bool orthographic = orthographic_member && orthographic_member->boolean();
    if (value.member("eye")) {
        for (const char* name : {"azimuth", "elevation", "zoom"})
            if (const auto extra = value.member(name)) extra->fail("nothing beside \"eye\"");
        Camera camera;
        camera.eye = value.required("eye").vector();
        camera.target = value.required("target").vector();
        if (const auto up = value.member("up")) camera.up = direction(*up);
        camera.fov_y_degrees = fov;
        camera.orthographic = orthographic;
        if (orthographic) camera.orthographic_height = value.required("height").positive_number();
        if (glm::length(glm::cross(camera.target - camera.eye, camera.up)) == 0)
            value.fail("eye and target apart, and up in another direction");
        scene.camera = camera;
        return;
    }
    for (const char* name : {"target", "up", "height"})
        if (const auto extra = value.member(name)) extra->fail("\"eye\" beside it");
    scene.framing.fov_y_degrees = fov;
    scene.framing.orthographic = orthographic;
    if (const auto azimuth = value.member("azimuth")) scene.framing.azimuth_degrees = azimuth->any_number();
    if (const auto elevation = value.member("elevation"))
        scene.framing.elevation_degrees = elevation->number(-90, 90, "an angle from -90 to 90 degrees");
    if (const auto zoom = value.member("zoom")) scene.framing.zoom = zoom->number(1e-6, 1e6, "a positive number");
}

Camera read_placed_camera(const JsonValue& value) {
    SceneDescription placed;
    read_camera(value, placed);
    if (!placed.camera) value.fail("a camera with eye and target");
    return *placed.camera;
}

std::vector<CameraBookmark> read_bookmarks(const JsonValue& value) {
    std::vector<CameraBookmark> bookmarks;
    const std::size_t count = value.array_size(0);
    for (std::size_t i = 0; i < count; ++i) {
        const JsonValue element = value.element(i);
        element.expect_members({"name", "camera"});
        const std::string name = element.required("name").string();
        const bool known = std::any_of(bookmarks.begin(), bookmarks.end(),
                                       [&](const CameraBookmark& other) { return other.name == name; });
        if (name.empty() || known) element.required("name").fail("a name that no bookmark before has");
        bookmarks.push_back({name, read_placed_camera(element.required("camera"))});
    }
    return bookmarks;
}

Light read_light(const JsonValue& value) {
    value.expect_members({"type", "space", "direction", "position", "range", "colour", "intensity"});
    Light light;
    light.kind = choice(value.required("type"),
                        Names<LightKind, 2>{{{LightKind::kDirectional, "directional"}, {LightKind::kPoint, "point"}}});
    if (const auto space = value.member("space"))
        light.space =
            choice(*space, Names<LightSpace, 2>{{{LightSpace::kWorld, "world"}, {LightSpace::kCamera, "camera"}}});
    if (light.kind == LightKind::kDirectional) {
        for (const char* name : {"position", "range"})
            if (const auto extra = value.member(name)) extra->fail("nothing: the light is directional");
        light.direction = direction(value.required("direction"));
    } else {
        if (const auto extra = value.member("direction")) extra->fail("nothing: the light is a point");
        light.position = value.required("position").vector();
        light.range = value.required("range").number(1 / kLargest, kLargest, "a positive number from 1e-30 to 1e30");
    }
    if (const auto colour = value.member("colour")) light.colour = linear_colour(*colour);
    if (const auto intensity = value.member("intensity"))
        light.colour *= intensity->number(0, kLargest, "a number that is not negative");
    return light;
}

Lighting read_lighting(const JsonValue& value) {
    value.expect_members({"ambient", "specular", "shininess", "highlight", "rim", "rim_exponent", "lights"});
    Lighting lighting = default_lighting();
    if (const auto ambient = value.member("ambient")) lighting.ambient = linear_colour(*ambient);
    if (const auto specular = value.member("specular"))
        lighting.specular = specular->number(0, kLargest, "a number that is not negative");
    if (const auto shininess = value.member("shininess"))
        lighting.shininess = shininess->number(1, 1e6, "a number from 1 to 1000000");
    if (const auto highlight = value.member("highlight"))
        lighting.highlight = choice(*highlight, Names<HighlightModel, 2>{{{HighlightModel::kBlinnPhong, "blinn-phong"},
                                                                          {HighlightModel::kPhong, "phong"}}});
    if (const auto rim = value.member("rim")) lighting.rim = rim->number(0, kLargest, "a number that is not negative");
    if (const auto exponent = value.member("rim_exponent"))
        lighting.rim_exponent = exponent->number(1, 1e6, "a number from 1 to 1000000");
    if (const auto lights = value.member("lights")) {
        lighting.lights.clear();
        const std::size_t count = lights->array_size(0);
        for (std::size_t i = 0; i < count; ++i)
            lighting.lights.push_back(read_light(lights->element(i)));
    }
    return lighting;
}

Background read_background(const JsonValue& value) {
    Background background;
    const std::string text = value.is_string() ? value.string() : "";
    background.transparent = text == "transparent";
    if (background.transparent) return background;
    const auto colour = parse_colour(text);
    if (!colour) value.fail("a colour like \"#ff8000\", or \"transparent\"");
    background.colour = *colour;
    return background;
}

// Members that are not there leave what `look` has.
void read_look(const JsonValue& value, SceneLook& look) {
    if (const auto view = value.member("view")) {
        const auto known = find_named(kViewNames, view->is_string() ? view->string() : "");
        if (!known) view->fail("the name of a view, such as \"shaded\"");
        look.view = *known;
    }
    if (const auto shown = value.member("show")) look.shown = choice(*shown, kShownNames);
    if (const auto backend = value.member("backend")) look.backend = choice(*backend, kBackendNames);
    if (const auto sides = value.member("sides")) look.sides = choice(*sides, kSidesNames);
    if (const auto epsilon = value.member("epsilon_scale"))
        look.epsilon_scale = epsilon->number(0, 100, "a number from 0 to 100");
    if (const auto prefilter = value.member("prefilter")) look.prefilter = prefilter->boolean();
    if (const auto shading = value.member("shading")) look.shading = choice(*shading, kShadingNames);
    if (const auto antialias = value.member("antialias"))
        look.antialias = antialias->whole_number(1, kMostSamplesPerSide);
    if (const auto merge = value.member("merge"))
        look.merge_px = merge->number(0, kMostMergePixels, "a number from 0 to 64");
    if (const auto tau = value.member("tau")) look.tau = tau->number(0, kMostTau, "a number from 0 to 1000");
    if (const auto kernel = value.member("kernel")) {
        const auto known = parse_kernel(kernel->is_string() ? kernel->string() : "");
        if (!known) kernel->fail("a kernel, such as \"gaussian:0.5\", \"confetti:6,1.5,3\", \"constant\" or \"disk\"");
        look.kernel = *known;
    }
}

void read_render(const JsonValue& value, SceneDescription& scene) {
    value.expect_members({"size", "view", "show", "backend", "sides", "epsilon_scale", "prefilter", "antialias",
                          "shading", "merge", "tau", "kernel", "levels_from"});
    constexpr std::uint32_t kLargestSide = 1u << 16;
    if (const auto size = value.member("size")) {
        size->array_size(2, 2);
        scene.width = size->element(0).whole_number(1, kLargestSide);
        scene.height = size->element(1).whole_number(1, kLargestSide);
    }
    read_look(value, scene.look);
    if (const auto camera = value.member("levels_from")) scene.levels_from = read_placed_camera(*camera);
}

SceneComparison read_comparison(const JsonValue& value, const SceneLook& left) {
    value.expect_members({"kind", "wipe", "right"});
    SceneComparison comparison{.right = left};
    comparison.kind = choice(value.required("kind"), kComparisonNames);
    if (const auto wipe = value.member("wipe")) comparison.wipe = wipe->number(0, 1, "a number from 0 to 1");
    if (const auto right = value.member("right")) {
        right->expect_members({"view", "show", "backend", "sides", "epsilon_scale", "prefilter", "antialias", "shading",
                               "merge", "tau", "kernel"});
        read_look(*right, comparison.right);
    }
    return comparison;
}

std::string place_of(std::string_view text, std::size_t byte) {
    const std::string_view before = text.substr(0, byte);
    const auto line = 1 + std::count(before.begin(), before.end(), '\n');
    const std::size_t column = 1 + before.size() - (before.rfind('\n') + 1);  // npos + 1 is 0
    return "line " + std::to_string(line) + ", column " + std::to_string(column);
}

/// What comes after `mark` in a message of the JSON library; all of it where there is no mark.
std::string_view after(std::string_view message, std::string_view mark) {
    const std::size_t at = message.find(mark);
    return at == std::string_view::npos ? message : message.substr(at + mark.size());
}

nlohmann::json parse_json(std::string_view text, const std::string& name) {
    try {
        return nlohmann::json::parse(text);
    } catch (const nlohmann::json::parse_error& error) {
        const std::size_t byte = error.byte > 0 ? error.byte - 1 : 0;  // counted from 1
        throw InputError(name, place_of(text, byte), "not valid JSON: " + printable(after(error.what(), " - ")));
    } catch (const nlohmann::json::exception& error) {
        // "... number overflow parsing '1e999'": says which one, not where.
        std::string_view number = after(error.what(), "parsing '");
        number = number.substr(0, number.find('\''));
        throw InputError(name, place_of(text, text.find(number)),
                         "not valid JSON: the number " + printable(number) + " is out of range");
    }
}

}  // namespace

std::optional<glm::dvec3> parse_colour(std::string_view text) {
    static constexpr std::array<std::pair<std::string_view, std::uint32_t>, 7> kNames{{{"white", 0xffffff},
                                                                                       {"black", 0x000000},
                                                                                       {"grey", 0x808080},
                                                                                       {"red", 0xff0000},
                                                                                       {"green", 0x00ff00},
                                                                                       {"blue", 0x0000ff},
                                                                                       {"sky", 0xb4d2f0}}};
    const auto of_bits = [](std::uint32_t rgb) {
        return glm::dvec3((rgb >> 16) & 255, (rgb >> 8) & 255, rgb & 255) / 255.0;
    };
    for (const auto& [name, rgb] : kNames)
        if (name == text) return of_bits(rgb);
    if (text.empty() || text[0] != '#' || (text.size() != 4 && text.size() != 7)) return std::nullopt;
    std::uint32_t rgb = 0;
    for (const char c : text.substr(1)) {
        if (std::isxdigit(static_cast<unsigned char>(c)) == 0) return std::nullopt;
        const auto digit = static_cast<std::uint32_t>(std::isdigit(static_cast<unsigned char>(c))
                                                          ? c - '0'
                                                          : std::tolower(static_cast<unsigned char>(c)) - 'a' + 10);
        rgb = rgb * 16 + digit;
        if (text.size() == 4) rgb = rgb * 16 + digit;
    }
    return of_bits(rgb);
}

SceneDescription parse_scene(std::string_view text, const std::string& name, const std::filesystem::path& folder) {
    const nlohmann::json json = parse_json(text, name);
    const JsonValue root(json, name);
    root.expect_members({"models", "camera", "lighting", "background", "render", "comparison", "bookmarks"});
    SceneDescription scene;
    const JsonValue models = root.required("models");
    const std::size_t count = models.array_size(1);
    for (std::size_t i = 0; i < count; ++i)
        scene.models.push_back(read_model(models.element(i), folder));
    if (const auto camera = root.member("camera")) read_camera(*camera, scene);
    if (const auto lighting = root.member("lighting")) scene.lighting = read_lighting(*lighting);
    if (const auto background = root.member("background")) scene.background = read_background(*background);
    if (const auto render = root.member("render")) read_render(*render, scene);
    if (const auto comparison = root.member("comparison")) scene.comparison = read_comparison(*comparison, scene.look);
    if (const auto bookmarks = root.member("bookmarks")) scene.bookmarks = read_bookmarks(*bookmarks);
    return scene;
}

SceneDescription read_scene_file(const std::filesystem::path& path) {
    std::error_code status;
    if (std::filesystem::is_directory(path, status))
        throw SystemError("cannot read " + path.string() + ": is a directory");
    std::ifstream file(path, std::ios::binary);
    if (!file) throw SystemError("cannot read " + path.string() + ": " + std::strerror(errno));
    const std::string text{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
    return parse_scene(text, path.string(), path.parent_path());
}

}  // namespace splice
