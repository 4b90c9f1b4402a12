// What a frame is to show: the picture itself, or one of the thesis's explanatory pictures (figures 4.1 to 4.15).
#pragma once

#include "engine/scene/named.h"

#include <cstdint>

namespace splice {

/// Values are shared with shaders/glsl/include/frame.glsl.
enum class View : std::uint32_t {
    kShaded = 0,
    kDepth = 1,           // distance to the surface, near is bright
    kVisibility = 2,      // the depth buffer after the visibility pass, pushed back by epsilon (figure 4.5 a)
    kAccumulation = 3,    // weighted sums before normalisation (4.5 b)
    kNormals = 4,         // view-space normals as colours
    kPatches = 5,         // a colour each (4.1, 4.3)
    kRepresentation = 6,  // triangles against surfels
    kWireframe = 7,       // triangles as wires (4.2)
    kOverlap = 8,         // surfels contributing per pixel (4.15)
    kSamples = 9,         // a sparse subset of the surfels (4.4)
    kTrianglesOnly = 10,  // (4.11 c)
    kSurfelsOnly = 11,    // (4.11 d)
    kLevels = 12,         // levels of detail: depths in the point tree, levels of triangles
    kBoxes = 13,          // of the nodes that are drawn
};

inline constexpr Names<View, 14> kViewNames{{
    {View::kShaded, "shaded", "the picture"},
    {View::kDepth, "depth", "distance to the surface, near is bright"},
    {View::kVisibility, "visibility", "depth buffer after the visibility pass, moved back by epsilon"},
    {View::kAccumulation, "accumulation", "weighted sums before normalisation"},
    {View::kNormals, "normals", "normals as seen from the eye, x red, y green, z blue"},
    {View::kPatches, "patches", "a colour for each patch"},
    {View::kRepresentation, "representation", "triangle patches blue, surfel patches orange"},
    {View::kWireframe, "wireframe", "edges of the triangles that are drawn"},
    {View::kOverlap, "overlap", "surfels contributing per pixel, with a legend"},
    {View::kSamples, "samples", "a sparse subset of the surfels"},
    {View::kTrianglesOnly, "triangles-only", "triangle patches alone"},
    {View::kSurfelsOnly, "surfels-only", "surfel patches alone"},
    {View::kLevels, "levels",
     "what --tau chose: a colour for each level of ellipses and of triangles, grey for full detail"},
    {View::kBoxes, "boxes", "boxes of the nodes that are drawn, a colour for each level, over the surface in grey"},
}};

constexpr std::string_view name_of(View view) {
    return name_in(kViewNames, view);
}

}  // namespace splice
