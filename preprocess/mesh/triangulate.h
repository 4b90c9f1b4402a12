// Polygons -> triangles: ear clipping (Meisters 1975; Held 2001, "FIST") in the polygon's best plane, so that concave
// polygons and polygons whose holes are joined to the rim by a bridge keep their area.
#pragma once

#include "preprocess/mesh/indexed_mesh.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace splice {

/// Appends n - 2 triangles of corner numbers 0..n-1, wound as the polygon is. n >= 3; positions finite. A polygon that
/// is not simple gets triangles all the same. Deterministic; O(n r / cells) with r reflex corners in a grid.
void triangulate_polygon(std::span<const Vec3d> corners, std::vector<std::array<std::uint32_t, 3>>& triangles);

}  // namespace splice
