#include "engine/scene/scene_file.h"

#include <nlohmann/json.hpp>

#include <cmath>
#include <cstdio>

namespace splice {

namespace {

using Json = nlohmann::ordered_json;

Json json_of(const glm::dvec3& v) {
    return Json::array({v.x, v.y, v.z});
}

// The way back from a rotation matrix to an axis and an angle; near half a turn the matrix's own differences vanish,
// and its diagonal tells the axis.
Json json_of_rotation(const glm::dmat3& m) {
    const glm::dvec3 twice_sine_axis(m[1][2] - m[2][1], m[2][0] - m[0][2], m[0][1] - m[1][0]);
    const double cosine = (m[0][0] + m[1][1] + m[2][2] - 1) / 2;
    const double angle = std::atan2(glm::length(twice_sine_axis) / 2, cosine);
    glm::dvec3 axis = twice_sine_axis;
    if (glm::length(axis) < 1e-6) {
        int largest = 0;
        for (int i = 1; i < 3; ++i)
            if (m[i][i] > m[largest][largest]) largest = i;
        axis = glm::dvec3(m[largest][0], m[largest][1], m[largest][2]);
        axis[largest] += 1;
    }
    return {{"axis", json_of(glm::normalize(axis))}, {"angle", glm::degrees(angle)}};
}

Json json_of(const Transform& transform) {
    Json json = Json::object();
    if (transform.scale != 1) json["scale"] = transform.scale;
    if (transform.rotation != glm::dmat3(1.0)) json["rotation"] = json_of_rotation(transform.rotation);
    if (transform.translation != glm::dvec3(0)) json["translation"] = json_of(transform.translation);
    return json;
}

Json json_of(const SceneModel& model, const std::filesystem::path& folder) {
    Json json;
    if (const auto* path = std::get_if<std::filesystem::path>(&model.source)) {
        const std::filesystem::path relative = path->lexically_proximate(folder);
        json["file"] = relative.empty() ? path->string() : relative.string();
    } else {
        const ShapeDescription& shape = std::get<ShapeDescription>(model.source);
        json["shape"]["kind"] = shape.kind;
        for (const auto& [name, value] : shape.parameters)
            json["shape"][name] = value;
    }
    if (const Json transform = json_of(model.transform); !transform.empty()) json["transform"] = transform;
    if (model.unit_box) json["unit_box"] = true;
    constexpr const char* representations[] = {"hybrid", "triangles", "surfels"};
    constexpr const char* selections[] = {"geometric", "thesis"};
    for (const std::string& member : model.bake_members) {
        if (member == "representation") json[member] = representations[static_cast<int>(model.representation)];
        if (member == "selection") json[member] = selections[static_cast<int>(model.selection)];
        if (member == "sampling") json[member] = model.sampling ? Json(*model.sampling) : Json("adaptive");
        if (member == "triangle_share" && model.triangle_share) json[member] = *model.triangle_share;
        if (member == "max_spacing" && model.max_spacing) json[member] = *model.max_spacing;
    }
    return json;
}

Json json_of(const Camera& camera) {
    Json json{{"eye", json_of(camera.eye)}, {"target", json_of(camera.target)}, {"up", json_of(camera.up)}};
    json["fov"] = camera.fov_y_degrees;
    if (camera.orthographic) {
        json["orthographic"] = true;
        json["height"] = camera.orthographic_height;
    }
    return json;
}

Json json_of(const Framing& framing) {
    return {{"azimuth", framing.azimuth_degrees},
            {"elevation", framing.elevation_degrees},
            {"zoom", framing.zoom},
            {"fov", framing.fov_y_degrees},
            {"orthographic", framing.orthographic}};
}

Json json_of(const Light& light) {
    Json json;
    const bool directional = light.kind == LightKind::kDirectional;
    json["type"] = directional ? "directional" : "point";
    json["space"] = light.space == LightSpace::kCamera ? "camera" : "world";
    if (directional) {
        json["direction"] = json_of(light.direction);
    } else {
        json["position"] = json_of(light.position);
        json["range"] = light.range;
    }
    json["colour"] = json_of(light.colour);
    return json;
}

Json json_of(const Lighting& lighting) {
    Json json{{"ambient", json_of(lighting.ambient)}, {"specular", lighting.specular}};
    json["shininess"] = lighting.shininess;
    json["highlight"] = lighting.highlight == HighlightModel::kPhong ? "phong" : "blinn-phong";
    json["rim"] = lighting.rim;
    json["rim_exponent"] = lighting.rim_exponent;
    json["lights"] = Json::array();
    for (const Light& light : lighting.lights)
        json["lights"].push_back(json_of(light));
    return json;
}

Json json_of(const SceneLook& look) {
    return {{"view", name_of(look.view)},
            {"show", name_of(look.shown)},
            {"backend", name_of(look.backend)},
            {"sides", name_of(look.sides)},
            {"epsilon_scale", look.epsilon_scale},
            {"prefilter", look.prefilter},
            {"antialias", look.antialias},
            {"shading", name_of(look.shading)},
            {"merge", look.merge_px},
            {"tau", look.tau},
            {"kernel", text_of(look.kernel)}};
}

std::string text_of(const Background& background) {
    if (background.transparent) return "transparent";
    const auto channel = [](double value) { return static_cast<unsigned>(std::lround(value * 255)) & 255U; };
    char text[8];
    std::snprintf(text, sizeof text, "#%02x%02x%02x", channel(background.colour.r), channel(background.colour.g),
                  channel(background.colour.b));
    return text;
}

}  // namespace

std::string write_scene(const SceneDescription& scene, const std::filesystem::path& folder) {
    Json json;
    for (const SceneModel& model : scene.models)
        json["models"].push_back(json_of(model, folder));
    json["camera"] = scene.camera ? json_of(*scene.camera) : json_of(scene.framing);
    json["lighting"] = json_of(scene.lighting);
    json["background"] = text_of(scene.background);
    json["render"] = json_of(scene.look);
    json["render"]["size"] = {scene.width, scene.height};
    if (scene.levels_from) json["render"]["levels_from"] = json_of(*scene.levels_from);
    if (scene.comparison.kind != Comparison::kOff)
        json["comparison"] = {{"kind", name_in(kComparisonNames, scene.comparison.kind)},
                              {"wipe", scene.comparison.wipe},
                              {"right", json_of(scene.comparison.right)}};
    for (const CameraBookmark& bookmark : scene.bookmarks)
        json["bookmarks"].push_back({{"name", bookmark.name}, {"camera", json_of(bookmark.camera)}});
    return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace splice
