// What lies around a place of the surface, measured on the cells of a grid that stand for it.
#pragma once

#include "preprocess/mesh/indexed_mesh.h"
#include "preprocess/vector_width.h"

#include <array>
#include <cstdint>
#include <span>

namespace splice {

/// The surface inside one grid cell that faces one way. Unit-box units.
struct Cell {
    Vec3f position = Vec3f::Zero();    // area-weighted mean
    Vec3f normal_sum = Vec3f::Zero();  // area weighted
    Vec3f direction = Vec3f::Zero();   // unit
    float area = 0;
    float triangles = 0;  // fractions of them
};

/// All within kRoughnessRadius: the spread of normals of everything and of what faces the same way, in radians, and the
/// number of triangles, as on a whole disk of that radius.
struct Neighbourhood {
    float ball, sheet, triangles;
};

/// How many centres the widest vectors hold.
inline constexpr std::uint32_t kCentresAtOnce = 8;

using CellRuns = std::array<std::span<const Cell>, 9>;

/// What lies around each of `centres`; `runs` hold all cells near them.
void look_around(const CellRuns& runs, std::span<const Cell> centres, Neighbourhood* out,
                 VectorWidth widest = VectorWidth::k256);

}  // namespace splice
