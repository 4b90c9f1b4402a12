// Steps that several readers share.
#pragma once

#include "preprocess/mesh/companion_files.h"
#include "preprocess/mesh/read_mesh.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

namespace splice {

using Vec2d = Eigen::Vector2d;

/// Stands for a vertex reference that no file can mean; repair_mesh drops its polygon.
inline constexpr std::uint32_t kInvalidIndex = 0xffffffffu;

/// A zero-based index from a number as the file has it.
inline std::uint32_t to_index(double value) {
    return value >= 0 && value < static_cast<double>(kInvalidIndex) && value == std::floor(value)
               ? static_cast<std::uint32_t>(value)
               : kInvalidIndex;
}

/// Opaque sRGB RGBA8 from components of 0..1; not-a-number counts as 1.
inline std::uint32_t pack_colour(double r, double g, double b) {
    const auto component = [](double c) {
        return std::isnan(c) ? 255u : static_cast<std::uint32_t>(std::lround(std::clamp(c, 0.0, 1.0) * 255.0));
    };
    return component(r) | (component(g) << 8) | (component(b) << 16) | 0xff000000u;
}

/// Adds to mesh.warnings, but not without end: after twenty one more says that there are more.
void warn(SourceMesh& mesh, const std::string& warning);

/// Attributes as files bind them to vertices; each empty or one a vertex.
struct VertexAttributes {
    std::vector<Vec3f> normals;
    std::vector<Vec2f> uvs;
    std::vector<std::uint32_t> colours;
};

/// Fills the corner arrays that `mesh` does not have yet. An attribute list that is too short leaves zero normals, zero
/// uvs and white.
void expand_vertex_attributes(const VertexAttributes& attributes, SourceMesh& mesh);

/// Gives each corner the value of its polygon; `per_polygon` may be too short.
template <class Value>
std::vector<Value> expand_polygon_values(const std::vector<Value>& per_polygon, const Value& missing,
                                         const SourceMesh& mesh) {
    std::vector<Value> corners(mesh.corner_position.size(), missing);
    const std::size_t polygons = std::min(per_polygon.size(), mesh.polygon_begin.size() - 1);
    for (std::size_t p = 0; p < polygons; ++p) {
        std::fill(corners.begin() + static_cast<std::ptrdiff_t>(mesh.polygon_begin[p]),
                  corners.begin() + static_cast<std::ptrdiff_t>(mesh.polygon_begin[p + 1]), per_polygon[p]);
    }
    return corners;
}

/// Appends a material that shows `image_name`; white when the image cannot be had (a warning says why).
void add_image_material(const std::string& image_name, const CompanionFiles& companions, SourceMesh& mesh);

}  // namespace splice
