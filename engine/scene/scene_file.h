// Scene files (docs/scene_format.md): JSON -> plain description. Only parsing and checking; models are loaded
// elsewhere.
#pragma once

#include "engine/scene/camera.h"
#include "engine/scene/scene.h"
#include "engine/scene/scene_look.h"

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace splice {

inline constexpr double kMostTau = 1000;  // pixels

/// Of a pixel; more than this no eye tells from this.
inline constexpr std::uint32_t kMostSamplesPerSide = 8;

/// A procedural model: "kind" and its numbers, checked against what the kind takes.
struct ShapeDescription {
    std::string kind;
    std::map<std::string, double> parameters;  // those that the file gives
};

// How meshes and shapes are baked on loading, as splice-bake's options of these names.
enum class SceneRepresentation { kHybrid, kTriangles, kSurfels };
enum class SceneSelection { kGeometric, kThesis };

struct SceneModel {
    std::variant<std::filesystem::path, ShapeDescription> source;  // paths are resolved against the scene file's folder
    Transform transform;
    bool unit_box = false;  // first moved and scaled so that its bounding box is centred and its longest side is 1
    // Of meshes and shapes, baked on loading.
    SceneRepresentation representation = SceneRepresentation::kHybrid;
    SceneSelection selection = SceneSelection::kGeometric;
    std::optional<double> triangle_share;
    std::optional<double> sampling;         // the published spacing's c; none: adaptive
    std::optional<double> max_spacing;      // of surfels, unit-box units
    std::vector<std::string> bake_members;  // those of the last five that the file gives, by name
};

/// A place to come back to.
struct CameraBookmark {
    std::string name;  // not empty, none twice
    Camera camera;     // clip planes are not set
};

struct SceneDescription {
    std::vector<SceneModel> models;  // at least one
    std::optional<Camera> camera;    // eye and target given; clip planes are not set
    Framing framing;                 // else how to frame the models
    Lighting lighting = default_lighting();
    Background background;
    std::vector<CameraBookmark> bookmarks;
    std::uint32_t width = 512, height = 512;
    SceneLook look;
    SceneComparison comparison;
    std::optional<Camera> levels_from;  // from where levels of detail are chosen, else from the camera
};

/// Throws InputError("FILE: /path/of/value: expected ..., got ..."), SystemError.
SceneDescription read_scene_file(const std::filesystem::path& path);

/// The same from text; `name` is for messages, `folder` is where relative paths start.
SceneDescription parse_scene(std::string_view text, const std::string& name, const std::filesystem::path& folder);

/// The scene as a file whose folder is `folder`: reading it gives the same description, numbers exact (rotations to
/// 1e-12).
std::string write_scene(const SceneDescription& scene, const std::filesystem::path& folder);

/// "#rgb", "#rrggbb", or a name out of white, black, grey, red, green, blue, sky: sRGB-encoded, 0..1.
std::optional<glm::dvec3> parse_colour(std::string_view text);

}  // namespace splice
