// Procedural meshes for scenes and tests. Same arguments, same bytes. All are wound counter-clockwise from outside and,
// but for the plane and the terrain, closed. Arguments below the stated least value are raised to it.
#pragma once

#include "preprocess/mesh/read_mesh.h"

#include <cstdint>

namespace splice::shapes {

/// Edge length 1 around the origin; each face `cells` x `cells` quads (at least 1), corners shared between faces.
SourceMesh cube(std::uint32_t cells = 1);

/// Radius 1 around the origin, poles on the z axis; uv over the whole sphere. At least 3 slices and 2 stacks.
SourceMesh uv_sphere(std::uint32_t slices, std::uint32_t stacks);

/// Icosahedron, each face split into frequency^2 triangles (at least 1), projected onto the unit sphere: 20
/// frequency^2.
SourceMesh ico_sphere(std::uint32_t frequency);

/// Radius of the bumpy sphere in unit direction (x, y, z), and the outward unit normal there (analytic):
/// r = 1 + 0.06 sin 7x sin(7y + 1) sin(7z + 2) + 0.01 sin(31x + 17y) sin 29z.
double bumpy_radius(const Vec3d& direction);
Vec3d bumpy_normal(const Vec3d& direction);

/// The surface of bumpy_radius over ico_sphere, with analytic normals and colour (0, 0.25, 1) (linear, stored as sRGB);
/// the least frequency that gives `triangles`.
SourceMesh bumpy_sphere(std::uint64_t triangles);

/// Tube along the (p, q) torus knot: p turns around the axis, q through the hole; `segments` along (at least 3 p q),
/// `sides` around (at least 3), coloured along its length.
SourceMesh torus_knot(std::uint32_t p, std::uint32_t q, std::uint32_t segments, std::uint32_t sides);

/// Height field over 1 x 1 in x and y, z up: seven octaves of gradient noise; coloured by height and slope.
/// `cells` x `cells` x 2 triangles.
SourceMesh terrain(std::uint32_t cells, std::uint32_t seed = 1);

/// Square 1 x 1 in x and y, z up, `cells` x `cells` quads, with a black and white image of `tiles` x `tiles` squares.
SourceMesh checkerboard(std::uint32_t tiles, std::uint32_t cells = 1);

/// A machined block: 2 x 2 x 0.8 with chamfered rims, a round boss on top and a chamfered bore through both; sharp
/// convex and concave edges, plane and cylindrical faces. `segments` around the bore, at least 8, rounded up to a
/// multiple of 8.
SourceMesh machined_part(std::uint32_t segments);

}  // namespace splice::shapes
